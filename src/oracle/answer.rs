//! The other side of the protocol: how a filter in Rust answers the messages of a check.
//!
//! It turns any [`Subject`] into a program under test.

use super::problem::{FORMAT, FORMAT_2, ProblemFile};
use super::subject::{Answer, Broken, Precision, Ready, Subject};
use serde_json::{Value, json};

/// What follows from a line that came in.
#[derive(Debug, Clone, PartialEq)]
pub enum Message {
    /// The line to answer with.
    Reply(String),
    /// The check is over.
    Stop,
    /// The line is not a message.
    NotUnderstood(String),
}

/// The answer of a subject to a line.
///
/// Example: one line in, one line out; here this crate's own filter answers.
///
/// ```
/// use immaculate::oracle::answer::{Message, respond};
/// use immaculate::oracle::subject::{Level, Planted};
///
/// let mut filter = Planted { variants: vec![], level: Level::Everything };
/// let Message::Reply(line) = respond(&mut filter, r#"{ "type": "start" }"#) else { panic!("it introduces itself") };
/// assert!(line.contains(r#""type":"ready""#) && line.contains(r#""precision":"double""#));
/// assert_eq!(respond(&mut filter, r#"{ "type": "stop" }"#), Message::Stop);
/// ```
pub fn respond(subject: &mut dyn Subject, line: &str) -> Message {
    let message: Value = match serde_json::from_str(line) {
        Ok(message) => message,
        Err(error) => return Message::NotUnderstood(format!("not a message of the protocol: {error}")),
    };
    match message["type"].as_str() {
        Some("start") => match subject.start() {
            Ok(ready) => Message::Reply(ready_message(&ready).to_string()),
            Err(broken) => Message::NotUnderstood(broken.to_string()),
        },
        Some("run") => {
            let id = message["problem"]["id"].clone();
            Message::Reply(run(subject, &message["problem"], &id).to_string())
        }
        Some("stop") => Message::Stop,
        _ => Message::NotUnderstood("a message must have type \"start\", \"run\" or \"stop\"".into()),
    }
}

fn ready_message(ready: &Ready) -> Value {
    json!({
        "type": "ready",
        "name": ready.name,
        "precision": match ready.precision {
            Precision::Double => json!("double"),
            Precision::Single => json!("single"),
            Precision::DecimalDigits(digits) => json!({ "decimal_digits": digits }),
        },
        "conventions": ready.conventions,
        "kinds": ready.kinds,
        "formats": ready.formats.clone().unwrap_or_else(|| vec![FORMAT.to_owned(), FORMAT_2.to_owned()]),
        "echo": ready.echo,
        "validates": ready.validates,
    })
}

fn run(subject: &mut dyn Subject, problem: &Value, id: &Value) -> Value {
    let answer = match ProblemFile::parse(&problem.to_string()) {
        Ok(problem) => subject.run(&problem),
        Err(invalid) => Answer::Rejected {
            class: invalid.class.name().into(),
            reason: invalid.to_string(),
        },
    };
    match answer {
        Answer::Steps { trace, error } => {
            json!({ "type": "answer", "id": id, "steps": trace.steps_as_json(), "error": error })
        }
        Answer::Skipped { reason } => json!({ "type": "skipped", "id": id, "reason": reason }),
        Answer::Rejected { class, reason } => {
            json!({ "type": "rejected", "id": id, "class": class, "reason": reason })
        }
        Answer::Broken(Broken::Invalid(invalid)) => {
            json!({ "type": "rejected", "id": id, "class": invalid.class.name(), "reason": invalid.to_string() })
        }
        Answer::Broken(broken) => json!({ "type": "answer", "id": id, "steps": [], "error": broken.to_string() }),
    }
}
