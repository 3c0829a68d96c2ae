//! A program under test as a process that is started once and exchanges JSON lines.
//!
//! It detects a program that hangs, ends, floods or answers out of order. Separate threads read and write, so that nothing the program
//! does can block the check.

use super::pipes::{Line, keep_last, read_lines};
use super::problem::ProblemFile;
use super::subject::{Answer, Broken, ECHO, Ready, Subject};
use super::trace::{Dimensions, Trace, read_json};
use crate::file::LONGEST_LINE;
use crate::file::shortened;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::Write;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel, sync_channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// The protocol's name.
pub const PROTOCOL: &str = "immaculate-check/1";

/// At most this many unread lines are buffered; a program that writes faster is blocked.
const WAITING: usize = 4;

/// So much of the reason that a program gives is kept, characters.
const REASON_KEPT: usize = 500;

/// At most this many remarks are kept.
const REMARKS: usize = 100;

/// The time that a program has to end after `stop`.
const LAST_MOMENTS: Duration = Duration::from_secs(2);

/// A process under test.
pub struct Process {
    command: Vec<String>,
    limit: Duration,
    start_limit: Duration,
    running: Option<Running>,
    asked: BTreeSet<String>,
    remarks: Vec<String>,
}

/// A process that runs.
struct Running {
    child: Child,
    lines: Receiver<Line>,
    requests: Sender<String>,
    stderr: Arc<Mutex<String>>,
    /// Bytes that have arrived and are in no line yet.
    unfinished: Arc<AtomicUsize>,
    /// The last line since the last message that is none.
    passed_over: Option<String>,
    has_spoken: bool,
    has_answered: bool,
}

impl Process {
    /// A process from a command and its arguments, with a time limit for each answer. To start it has twenty seconds more: an
    /// interpreter may take a while.
    ///
    /// Example: A command that is not there is a reason in words.
    ///
    /// ```
    /// use immaculate::oracle::check::{Selection, check};
    /// use immaculate::oracle::process::Process;
    /// use std::time::Duration;
    ///
    /// let mut program = Process::new(vec!["no-such-filter".into()], Duration::from_secs(1));
    /// let reason = check(&mut program, &Selection::default(), &|_| {}).unwrap_err().to_string();
    /// assert!(reason.starts_with("`no-such-filter` cannot be started"));
    /// ```
    pub fn new(command: Vec<String>, limit: Duration) -> Self {
        Self {
            command,
            limit,
            start_limit: limit + Duration::from_secs(20),
            running: None,
            asked: BTreeSet::new(),
            remarks: Vec::new(),
        }
    }

    /// The same with another time limit for the first message.
    #[must_use]
    pub fn ready_within(mut self, start_limit: Duration) -> Self {
        self.start_limit = start_limit;
        self
    }

    /// Starts the process and exchanges the first messages.
    fn launch(&mut self) -> Result<Ready, Broken> {
        self.spawn()?;
        let ready = self.greet();
        if ready.is_err() {
            // What did not introduce itself is asked nothing.
            self.kill();
        }
        ready
    }

    /// Starts the process, and a thread for each of its pipes.
    fn spawn(&mut self) -> Result<(), Broken> {
        let (program, arguments) = self
            .command
            .split_first()
            .ok_or_else(|| Broken::NotStarted("no command was given after `--`".into()))?;
        let mut child = Command::new(program)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| {
                let hint = if program.contains(' ') && arguments.is_empty() {
                    "; a program and its arguments are words of their own, without quotes around them all"
                } else {
                    ""
                };
                Broken::NotStarted(format!("`{program}` cannot be started: {error}{hint}"))
            })?;
        let (line_sender, lines) = sync_channel(WAITING);
        let (requests, request_receiver) = channel::<String>();
        let stderr = Arc::new(Mutex::new(String::new()));
        let unfinished = Arc::new(AtomicUsize::new(0));
        if let Some(stdout) = child.stdout.take() {
            let unfinished = Arc::clone(&unfinished);
            std::thread::spawn(move || read_lines(stdout, &line_sender, &unfinished));
        }
        if let Some(mut stdin) = child.stdin.take() {
            std::thread::spawn(move || {
                for request in request_receiver {
                    if writeln!(stdin, "{request}").and_then(|()| stdin.flush()).is_err() {
                        break;
                    }
                }
            });
        }
        if let Some(pipe) = child.stderr.take() {
            let kept = Arc::clone(&stderr);
            std::thread::spawn(move || keep_last(pipe, &kept));
        }
        self.running = Some(Running {
            child,
            lines,
            requests,
            stderr,
            unfinished,
            passed_over: None,
            has_spoken: false,
            has_answered: false,
        });
        Ok(())
    }

    /// The first messages.
    fn greet(&mut self) -> Result<Ready, Broken> {
        self.send(&json!({
            "type": "start",
            "protocol": PROTOCOL,
            "echo": { "matrix": ECHO.0, "vector": ECHO.1 },
        }));
        let message = self.receive(Instant::now(), self.start_limit)?;
        match message.get("type").and_then(Value::as_str) {
            Some("ready") => Ready::read(&message).map_err(|reason| Broken::Garbage {
                line: beginning(&message.to_string()),
                reason,
            }),
            _ => Err(Broken::Garbage {
                line: beginning(&message.to_string()),
                reason: "the first message must have type \"ready\"".into(),
            }),
        }
    }

    fn send(&mut self, message: &Value) {
        if let Some(running) = &self.running {
            // A process that has ended is noticed when its answer is read.
            let _ = running.requests.send(message.to_string());
        }
    }

    /// The next message, if it comes within a time; lines that do not start with a brace are passed over.
    fn receive(&mut self, since: Instant, limit: Duration) -> Result<Value, Broken> {
        let Some(running) = &mut self.running else {
            return Err(Broken::NotStarted("the program is not running".into()));
        };
        let broken = loop {
            let left = (since + limit).saturating_duration_since(Instant::now());
            let line = if left.is_zero() {
                // A program that floods always has a line ready.
                Err(RecvTimeoutError::Timeout)
            } else {
                running.lines.recv_timeout(left)
            };
            match line {
                Ok(Line::Text(line)) => {
                    running.has_spoken = true;
                    // Some writers mark their text as UTF-8.
                    let text = line.strip_prefix('\u{feff}').unwrap_or(&line);
                    if !text.trim_start().starts_with('{') {
                        running.passed_over = Some(beginning(text)).filter(|line| !line.is_empty());
                        continue;
                    }
                    running.passed_over = None;
                    return read_json(text).map_err(|error| Broken::Garbage {
                        line: error.around.trim_end().to_owned(),
                        reason: error.reason,
                    });
                }
                Ok(Line::TooLong) => {
                    break Broken::Garbage {
                        line: String::new(),
                        reason: format!("a line longer than {LONGEST_LINE} bytes"),
                    };
                }
                Ok(Line::NotText) => {
                    break Broken::Garbage {
                        line: String::new(),
                        reason: "a line that is not UTF-8".into(),
                    };
                }
                Err(RecvTimeoutError::Timeout) => {
                    let is_flooded = left.is_zero();
                    break Broken::TimedOut {
                        seconds: limit.as_secs(),
                        hint: if is_flooded { String::new() } else { running.hint() },
                    };
                }
                Err(RecvTimeoutError::Disconnected) => break crashed(running),
            }
        };
        self.kill();
        Err(broken)
    }

    fn kill(&mut self) {
        if let Some(mut running) = self.running.take() {
            let _ = running.child.kill();
            let _ = running.child.wait();
        }
    }

    /// Asks a problem.
    fn ask(&mut self, problem: &ProblemFile) -> Result<Answer, Broken> {
        self.send(&json!({ "type": "run", "problem": problem }));
        let answer = self.answer(problem);
        if let Some(running) = &mut self.running {
            running.has_answered |= answer.is_ok();
        }
        answer
    }

    /// The answer to a problem; answers to problems that were asked before are remarked upon and passed over.
    fn answer(&mut self, problem: &ProblemFile) -> Result<Answer, Broken> {
        let since = Instant::now();
        loop {
            let message = self.receive(since, self.limit)?;
            let id = message.get("id").and_then(Value::as_str).unwrap_or_default().to_owned();
            if id != problem.id && self.asked.contains(&id) {
                remark(&mut self.remarks, format!("answered `{id}` late or more than once"));
                continue;
            }
            if id != problem.id {
                return Err(Broken::OutOfOrder {
                    asked: problem.id.clone(),
                    answered: beginning(&id),
                });
            }
            return read_answer(&message, &problem.dimensions());
        }
    }
}

impl Running {
    /// What may be why no message came.
    fn hint(&self) -> String {
        let unfinished = self.unfinished.load(Ordering::Relaxed);
        match &self.passed_over {
            Some(line) if line.contains('\0') => "; what has arrived is UTF-16, and messages are UTF-8".to_owned(),
            _ if unfinished > 0 => {
                format!("; {unfinished} bytes without a newline have arrived, and every message ends with one")
            }
            Some(line) => format!("; a line that does not begin with `{{` was passed over: {line}"),
            None if self.has_spoken => String::new(),
            None => "; nothing has arrived at all: does the program flush its output after every line?".to_owned(),
        }
    }
}

impl Subject for Process {
    fn start(&mut self) -> Result<Ready, Broken> {
        self.launch()
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        if self.running.is_none()
            && let Err(broken) = self.launch()
        {
            return Answer::Broken(broken);
        }
        self.asked.insert(problem.id.clone());
        let has_answered = self.running.as_ref().is_some_and(|running| running.has_answered);
        let is_over = |broken: &Broken| matches!(broken, Broken::Crashed { status, .. } if *status == in_order());
        match self.ask(problem) {
            Err(broken) if has_answered && is_over(&broken) => {
                let sentence =
                    "ended after an answer, in order, and was started again; it is meant to answer until `stop`";
                remark(&mut self.remarks, sentence.to_owned());
                self.launch().and_then(|_| self.ask(problem))
            }
            answer => answer,
        }
        .unwrap_or_else(Answer::Broken)
    }

    fn stop(&mut self) -> Vec<String> {
        self.send(&json!({ "type": "stop" }));
        let end = Instant::now() + LAST_MOMENTS;
        if let Some(running) = &mut self.running {
            // Its input ends, too, after what is still to be written.
            running.requests = channel().0;
            // The lines end when the program does.
            while let Ok(line) = running
                .lines
                .recv_timeout(end.saturating_duration_since(Instant::now()))
            {
                if let Line::Text(line) = line
                    && line.trim_start().starts_with('{')
                {
                    let sentence = format!("said more than it was asked for: {}", beginning(&line));
                    remark(&mut self.remarks, sentence);
                }
                if Instant::now() > end {
                    break;
                }
            }
            end_of(&mut running.child, end);
        }
        self.kill();
        std::mem::take(&mut self.remarks)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.kill();
    }
}

/// Reads an answer message.
///
/// # Errors
///
/// [`Broken`] when it is not one.
pub fn read_answer(message: &Value, dimensions: &Dimensions) -> Result<Answer, Broken> {
    if !message.is_object() {
        return Err(Broken::Garbage {
            line: beginning(&message.to_string()),
            reason: "an answer is an object".into(),
        });
    }
    let text = |key: &str| {
        shortened(
            message.get(key).and_then(Value::as_str).unwrap_or_default(),
            REASON_KEPT,
        )
    };
    match message.get("type").and_then(Value::as_str) {
        Some("answer") | None => {
            for key in message.as_object().into_iter().flat_map(|object| object.keys()) {
                if !["type", "id", "format", "steps", "error", "scale", "noise"].contains(&key.as_str()) {
                    let reason = format!("`{}` is not a key of an answer", beginning(key));
                    let line = beginning(&message.to_string());
                    return Err(Broken::Garbage { line, reason });
                }
            }
            let error = error_of(message.get("error"));
            let empty = Value::Array(Vec::new());
            let steps = message.get("steps").unwrap_or(&empty);
            let trace = Trace::from_json(steps, dimensions).map_err(Broken::Invalid)?;
            Ok(Answer::Steps { trace, error })
        }
        Some("skipped") => Ok(Answer::Skipped { reason: text("reason") }),
        Some("rejected") => Ok(Answer::Rejected {
            class: text("class"),
            reason: text("reason"),
        }),
        Some(other) => Err(Broken::Garbage {
            line: beginning(&message.to_string()),
            reason: format!("{:?} is not the type of an answer", beginning(other)),
        }),
    }
}

/// Why a program stopped before the end. Some writers have an empty text or list for nothing.
fn error_of(value: Option<&Value>) -> Option<String> {
    match value? {
        Value::Null | Value::Bool(false) => None,
        Value::String(text) => (!text.trim().is_empty()).then(|| shortened(text, REASON_KEPT)),
        Value::Array(list) if list.is_empty() => None,
        Value::Object(object) if object.is_empty() => None,
        other => Some(beginning(&other.to_string())),
    }
}

/// A remark, once, as long as there are not too many.
fn remark(remarks: &mut Vec<String>, sentence: String) {
    if remarks.len() < REMARKS && !remarks.contains(&sentence) {
        remarks.push(sentence);
    }
}

/// The status of a process that has ended in order.
fn in_order() -> String {
    ExitStatus::default().to_string()
}

/// How a process ended, if it does in time.
fn end_of(child: &mut Child, end: Instant) -> Option<ExitStatus> {
    loop {
        match child.try_wait() {
            Ok(None) if Instant::now() < end => std::thread::sleep(Duration::from_millis(5)),
            Ok(status) => return status,
            Err(_) => return None,
        }
    }
}

fn crashed(running: &mut Running) -> Broken {
    let status = end_of(&mut running.child, Instant::now() + LAST_MOMENTS / 4).map_or_else(
        || "it closed its output and went on".to_owned(),
        |status| status.to_string(),
    );
    // What it wrote last may still be on its way.
    std::thread::sleep(Duration::from_millis(50));
    let stderr = running
        .stderr
        .lock()
        .map_or_else(|_| String::new(), |kept| kept.trim().to_owned());
    Broken::Crashed {
        status,
        stderr: if stderr.is_empty() {
            String::new()
        } else {
            format!(":\n{stderr}")
        },
    }
}

/// The beginning of a line, for a report.
fn beginning(line: &str) -> String {
    const KEPT: usize = 120;
    match line.trim_end().char_indices().nth(KEPT) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line.trim_end().to_owned(),
    }
}
