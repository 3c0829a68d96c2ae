//! A program under test as a process that is started once and spoken to in JSON lines.
//!
//! After this file the reader knows how a program that hangs, ends, floods or answers out of order is noticed. Reading and writing
//! happen in threads of their own, so that nothing the program does can block the check.

use super::problem::ProblemFile;
use super::subject::{Answer, Broken, ECHO, Ready, Subject};
use super::trace::{Dimensions, Trace, read_json};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// The protocol's name.
pub const PROTOCOL: &str = "immaculate-check/1";

/// No line of an answer may be longer, in bytes.
const LONGEST_LINE: u64 = 1 << 26;

/// So much of what a program writes to standard error is kept for a report.
const STDERR_KEPT: usize = 1000;

/// A process under test.
pub struct Process {
    command: Vec<String>,
    limit: Duration,
    running: Option<Running>,
    answered: BTreeSet<String>,
    remarks: Vec<String>,
}

/// A process that runs.
struct Running {
    child: Child,
    lines: Receiver<Line>,
    requests: Sender<String>,
    stderr: Arc<Mutex<String>>,
    has_spoken: bool,
}

/// What the reading thread found.
enum Line {
    Text(String),
    TooLong,
    NotText,
}

impl Process {
    /// A process from a command and its arguments, with a time limit for each answer.
    pub fn new(command: Vec<String>, limit: Duration) -> Self {
        Self {
            command,
            limit,
            running: None,
            answered: BTreeSet::new(),
            remarks: Vec::new(),
        }
    }

    /// Starts the process and exchanges the first messages.
    fn launch(&mut self) -> Result<Ready, Broken> {
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
            .map_err(|error| Broken::NotStarted(format!("`{program}` cannot be started: {error}")))?;
        let (line_sender, lines) = channel();
        let (requests, request_receiver) = channel::<String>();
        let stderr = Arc::new(Mutex::new(String::new()));
        if let Some(stdout) = child.stdout.take() {
            std::thread::spawn(move || read_lines(stdout, &line_sender));
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
            has_spoken: false,
        });
        self.send(&json!({
            "type": "start",
            "protocol": PROTOCOL,
            "echo": { "matrix": ECHO.0, "vector": ECHO.1 },
        }));
        // An interpreter may take a while to start.
        let message = self.receive(self.limit + Duration::from_secs(20))?;
        match message.get("type").and_then(Value::as_str) {
            Some("ready") => Ready::read(&message).map_err(|reason| Broken::Garbage {
                line: shortened(&message.to_string()),
                reason,
            }),
            _ => Err(Broken::Garbage {
                line: shortened(&message.to_string()),
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

    /// The next message; lines that do not start with a brace are passed over.
    fn receive(&mut self, limit: Duration) -> Result<Value, Broken> {
        let Some(running) = &mut self.running else {
            return Err(Broken::NotStarted("the program is not running".into()));
        };
        let end = Instant::now() + limit;
        let broken = loop {
            match running
                .lines
                .recv_timeout(end.saturating_duration_since(Instant::now()))
            {
                Ok(Line::Text(line)) => {
                    running.has_spoken = true;
                    if !line.trim_start().starts_with('{') {
                        continue;
                    }
                    match read_json(&line) {
                        Ok(message) => return Ok(message),
                        Err(reason) => {
                            let line = shortened(&line);
                            return Err(Broken::Garbage { line, reason });
                        }
                    }
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
                    let hint = if running.has_spoken {
                        ""
                    } else {
                        "; nothing has arrived at all: does the program flush its output after every line?"
                    };
                    break Broken::TimedOut {
                        seconds: limit.as_secs(),
                        hint: hint.into(),
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

    /// The answer to a problem; answers to problems that were answered before are remarked upon and passed over.
    fn answer(&mut self, problem: &ProblemFile) -> Result<Answer, Broken> {
        let (n, m, r) = problem.dimensions();
        let dimensions = Dimensions {
            n,
            m,
            r,
            steps: problem.measurements.len(),
        };
        let end = Instant::now() + self.limit;
        loop {
            let message = self.receive(end.saturating_duration_since(Instant::now()))?;
            let id = message.get("id").and_then(Value::as_str).unwrap_or_default().to_owned();
            if id != problem.id && self.answered.contains(&id) {
                self.remarks.push(format!("answered `{id}` more than once"));
                continue;
            }
            if id != problem.id {
                return Err(Broken::OutOfOrder {
                    asked: problem.id.clone(),
                    answered: id,
                });
            }
            self.answered.insert(id);
            return read_answer(&message, dimensions);
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
        self.send(&json!({ "type": "run", "problem": problem }));
        self.answer(problem).unwrap_or_else(Answer::Broken)
    }

    fn stop(&mut self) -> Vec<String> {
        self.send(&json!({ "type": "stop" }));
        let end = Instant::now() + Duration::from_secs(2);
        if let Some(running) = &mut self.running {
            while Instant::now() < end && matches!(running.child.try_wait(), Ok(None)) {
                std::thread::sleep(Duration::from_millis(5));
            }
            for line in running.lines.try_iter() {
                if let Line::Text(line) = line
                    && line.trim_start().starts_with('{')
                {
                    self.remarks
                        .push(format!("said more than it was asked for: {}", shortened(&line)));
                }
            }
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
pub fn read_answer(message: &Value, dimensions: Dimensions) -> Result<Answer, Broken> {
    let text = |key: &str| message.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
    match message.get("type").and_then(Value::as_str) {
        Some("answer") | None => {
            for key in message.as_object().into_iter().flat_map(|object| object.keys()) {
                if !["type", "id", "format", "steps", "error", "scale", "noise"].contains(&key.as_str()) {
                    let reason = format!("`{key}` is not a key of an answer");
                    let line = shortened(&message.to_string());
                    return Err(Broken::Garbage { line, reason });
                }
            }
            let error = message.get("error").and_then(Value::as_str).map(str::to_owned);
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
            line: shortened(&message.to_string()),
            reason: format!("{other:?} is not the type of an answer"),
        }),
    }
}

fn read_lines(stdout: impl Read, lines: &Sender<Line>) {
    let mut reader = BufReader::new(stdout);
    loop {
        let mut bytes = Vec::new();
        let line = match reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes) {
            Ok(0) | Err(_) => return,
            Ok(length) if length as u64 == LONGEST_LINE => Line::TooLong,
            Ok(_) => String::from_utf8(bytes).map_or(Line::NotText, Line::Text),
        };
        if lines.send(line).is_err() {
            return;
        }
    }
}

/// Keeps the last part of what a program writes to standard error.
fn keep_last(mut pipe: impl Read, kept: &Mutex<String>) {
    let mut buffer = [0; 4096];
    while let Ok(count @ 1..) = pipe.read(&mut buffer) {
        let Ok(mut kept) = kept.lock() else { return };
        kept.push_str(&String::from_utf8_lossy(&buffer[..count]));
        if kept.len() > STDERR_KEPT {
            let mut start = kept.len() - STDERR_KEPT;
            while !kept.is_char_boundary(start) {
                start += 1;
            }
            kept.drain(..start);
        }
    }
}

fn crashed(running: &mut Running) -> Broken {
    let status = running
        .child
        .wait()
        .map_or_else(|error| error.to_string(), |status| status.to_string());
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
fn shortened(line: &str) -> String {
    const KEPT: usize = 120;
    match line.trim_end().char_indices().nth(KEPT) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line.trim_end().to_owned(),
    }
}
