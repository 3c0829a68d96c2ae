//! Goal: whatever a program under test does, the check ends in time, says what happened in a sentence, and calls nothing right that
//! was not judged.
//!
//! Method: programs that misbehave, each in one way: shell scripts for what happens in pipes and processes, a filter in this process
//! for what answers mean, folders of files, and the command line with its exit statuses. Kind of evidence: behaviour, by examples,
//! good and bad; what verdicts on numbers are worth is the oracle's own work.

#![cfg(unix)]

use immaculate::imm::Quantity;
use immaculate::oracle::answer::{Message, respond};
use immaculate::oracle::behaviour::Unasked;
use immaculate::oracle::case;
use immaculate::oracle::check::{CaseReport, NotMade, Outcome, Report, Selection, check};
use immaculate::oracle::diagnose::Diagnosis;
use immaculate::oracle::folder::Folder;
use immaculate::oracle::invalid::Class;
use immaculate::oracle::judge::Finding;
use immaculate::oracle::observation::Observation;
use immaculate::oracle::problem::ProblemFile;
use immaculate::oracle::process::{Process, read_answer};
use immaculate::oracle::subject::{Answer, Broken, Level, Planted, Precision, Ready, Subject};
use immaculate::oracle::trace::{Dimensions, Trace};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

/// Three cases of one step.
const THREE: [&str; 3] = ["update.kalman", "update.cubature-3", "update.simplex-5"];

/// The time that scripts have for an answer, and for the first message.
const LIMIT: Duration = Duration::from_secs(1);

/// The beginning of a script that introduces itself.
const READY: &str = r#"read -r line; echo '{"type":"ready","name":"script"}';"#;

// Programs that cannot be used at all

#[test]
fn a_program_that_cannot_be_started_is_named() {
    for (command, words) in [
        (
            vec!["/no/such/program".to_owned()],
            "`/no/such/program` cannot be started: ",
        ),
        (vec![root().display().to_string()], "cannot be started"),
        (Vec::new(), "no command was given"),
    ] {
        let not_made = verdict_on(&mut Process::new(command, LIMIT), &["update.kalman"]).unwrap_err();
        assert!(
            matches!(not_made, NotMade::Subject(Broken::NotStarted(_))),
            "{not_made:?}"
        );
        assert!(not_made.to_string().contains(words), "{not_made}");
    }
}

#[test]
fn a_program_that_never_says_anything_is_told_to_flush() {
    let sentence = refused("exec sleep 20");
    assert!(
        sentence.starts_with("no answer within 1 s; nothing has arrived at all") && sentence.contains("flush"),
        "{sentence}"
    );
}

#[test]
fn a_program_that_said_something_is_told_what_was_passed_over_and_not_to_flush() {
    for said in ["hello", "Loading... {\"type\": \"ready\"}"] {
        assert_eq!(
            refused(&format!("echo '{said}'; exec sleep 20")),
            format!("no answer within 1 s; a line that does not begin with `{{` was passed over: {said}")
        );
    }
    assert_eq!(refused("echo; exec sleep 20"), "no answer within 1 s");
}

#[test]
fn a_message_without_its_newline_is_told_so() {
    assert_eq!(
        refused("printf '{\"type\":\"ready\"}'; exec sleep 20"),
        "no answer within 1 s; 16 bytes without a newline have arrived, and every message ends with one"
    );
    let answers = Answers::new("no newline");
    let report = verdict(&answers.script(&[("update.cubature-3", "printf '{\"id\":'; sleep 20")]));
    assert_eq!(
        broken_sentence(&report, "update.cubature-3"),
        "no answer within 1 s; 6 bytes without a newline have arrived, and every message ends with one"
    );
    assert_others_are_right(&report, "update.cubature-3");
}

/// `{}` and a newline in UTF-16, the little end first and last.
#[test]
fn a_message_in_utf_16_is_told_so() {
    for said in ["\\377\\376{\\000}\\000\\n\\000", "\\376\\377\\000{\\000}\\000\\n"] {
        assert_eq!(
            refused(&format!("printf '{said}'; exec sleep 20")),
            "no answer within 1 s; what has arrived is UTF-16, and messages are UTF-8"
        );
    }
}

/// As files may begin.
#[test]
fn a_line_may_begin_with_a_byte_order_mark() {
    let answers = Answers::new("mark");
    let cat = format!("printf '\\357\\273\\277'; {}", answers.cat("update.kalman"));
    let script = answers.script(&[("update.kalman", &cat)]);
    let report = verdict(&script.replacen("echo '{", "printf '\\357\\273\\277'; echo '{", 1));
    assert_others_are_right(&report, "");
}

#[test]
fn a_command_in_one_word_is_told_that_arguments_are_words() {
    let refused = |command: &[&str]| {
        let command = command.iter().map(|&word| word.to_owned()).collect();
        let not_made = verdict_on(&mut Process::new(command, LIMIT), &["update.kalman"]).unwrap_err();
        not_made.to_string()
    };
    let hint = "a program and its arguments are words of their own";
    assert!(refused(&["python3 filter.py plain"]).contains(hint));
    assert!(!refused(&["/no/such/program"]).contains(hint));
    assert!(!refused(&["/no such/program", "plain"]).contains(hint));
}

#[test]
fn a_program_that_ends_after_every_answer_is_started_again_and_told() {
    let answers = Answers::new("once");
    let cats = THREE.map(|id| (id, format!("{}; exit 0", answers.cat(id))));
    let cats: Vec<(&str, &str)> = cats.iter().map(|(id, cat)| (*id, cat.as_str())).collect();
    let report = verdict(&answers.script(&cats));
    assert_others_are_right(&report, "");
    assert!(!report.is_wrong());
    assert_eq!(
        report.remarks,
        ["ended after an answer, in order, and was started again; it is meant to answer until `stop`"]
    );
    // One that ends in order without an answer is not started for ever.
    let report = verdict(&answers.script(&[("update.cubature-3", "exit 0")]));
    let sentence = broken_sentence(&report, "update.cubature-3");
    assert_eq!(sentence, "the program ended (exit status: 0)");
}

/// The place is shown, not the beginning of a long line.
#[test]
fn a_decimal_comma_is_shown_where_it_stands() {
    let answers = Answers::new("comma");
    let numbers = "0.5,".repeat(200);
    let report = verdict(&answers.script(&[("update.kalman", &format!("echo '{{\"steps\":[{numbers}0,05]}}'"))]));
    let sentence = broken_sentence(&report, "update.kalman");
    let words = "invalid number at line 1 column 814; is a number written with a decimal comma?: …";
    assert!(
        sentence.contains(words) && sentence.ends_with("0.5,0,05]}"),
        "{sentence}"
    );
    // Between numbers of a list a comma is a comma.
    let report = verdict(&answers.script(&[("update.kalman", "echo '{\"steps\":[1, 05]}'")]));
    let sentence = broken_sentence(&report, "update.kalman");
    assert!(
        sentence.starts_with("not a message: invalid number at line 1 column 15: {"),
        "{sentence}"
    );
}

#[test]
fn a_program_that_ends_before_it_introduces_itself_is_reported_with_its_last_words() {
    assert_eq!(refused("exit 3"), "the program ended (exit status: 3)");
    let sentence = refused("echo 'no module named filters' >&2; exit 1");
    assert_eq!(sentence, "the program ended (exit status: 1):\nno module named filters");
    let sentence = refused("kill -9 $$");
    assert!(sentence.contains("signal: 9"), "{sentence}");
}

#[test]
fn a_first_message_that_is_none_is_shown() {
    for (said, words) in [
        ("{\"type\":\"hello\"}", "the first message must have type \"ready\""),
        (
            "{\"type\":\"ready\",\"colour\":1}",
            "`colour` is not a key of the ready message",
        ),
        (
            "{\"type\":\"ready\",\"precision\":\"half\"}",
            "precision \"half\" is not",
        ),
        ("{\"type\":\"ready\"", "EOF while parsing"),
        ("{}", "the first message must have type \"ready\""),
    ] {
        let sentence = refused(&format!("read -r line; echo '{said}'; exec sleep 20"));
        assert!(
            sentence.starts_with("not a message: ") && sentence.contains(words),
            "{sentence}"
        );
        assert!(sentence.contains(&said[..10.min(said.len())]), "{sentence}");
    }
}

#[test]
fn a_convention_that_is_not_known_is_refused_with_those_that_are() {
    for (key, value) in [("square_root", "qr"), ("colour", "red")] {
        let mut double = Double::new(right);
        double.ready.conventions.insert(key.into(), value.into());
        let sentence = verdict_on(&mut double, &["update.kalman"]).unwrap_err().to_string();
        for words in [
            &format!("declares `{key}`: {value:?}"),
            "`square_root`: \"symmetric\"",
            "`first_step`",
        ] {
            assert!(sentence.contains(words), "{words} in {sentence}");
        }
        assert!(double.asked.is_empty(), "nothing is asked for");
    }
    // The cases' own may be declared.
    let mut double = Double::new(right);
    double
        .ready
        .conventions
        .insert("square_root".into(), "cholesky-lower".into());
    assert!(!verdict_on(&mut double, &["update.kalman"]).unwrap().is_wrong());
}

// Programs that stop answering

#[test]
fn a_case_without_an_answer_in_time_is_wrong_and_the_others_are_asked() {
    let answers = Answers::new("in time");
    let script = answers.script(&[("update.cubature-3", "sleep 20")]);
    let report = verdict(&script);
    assert_eq!(of(&report, "update.cubature-3").outcome, timed_out());
    assert_eq!(broken_sentence(&report, "update.cubature-3"), "no answer within 1 s");
    assert_others_are_right(&report, "update.cubature-3");
}

#[test]
fn a_program_that_ends_in_the_middle_is_started_again_for_the_others() {
    let answers = Answers::new("ends in the middle");
    let script = answers.script(&[("update.cubature-3", "echo 'singular matrix' >&2; exit 7")]);
    let report = verdict(&script);
    assert_eq!(
        broken_sentence(&report, "update.cubature-3"),
        "the program ended (exit status: 7):\nsingular matrix"
    );
    assert_others_are_right(&report, "update.cubature-3");
}

#[test]
fn a_program_that_closes_its_output_and_goes_on_is_stopped() {
    let start = Instant::now();
    let mut process = script(&format!("{READY} exec 1>&-; exec sleep 20"));
    let report = verdict_on(&mut process, &["update.kalman"]).unwrap();
    let sentence = broken_sentence(&report, "update.kalman");
    assert_eq!(sentence, "the program ended (it closed its output and went on)");
    assert!(start.elapsed() < Duration::from_secs(8));
}

/// Its exit status is waited for a moment: a program may close its output first.
#[test]
fn a_program_that_closes_its_output_and_ends_a_moment_later_is_reported_with_its_status() {
    assert_eq!(
        refused("exec 1>&-; sleep 0.1; exit 3"),
        "the program ended (exit status: 3)"
    );
}

/// Of what a program complains the end is kept, which says why it ended: a thousand bytes, and no half letter.
#[test]
fn of_a_long_complaint_the_end_is_kept() {
    let sentence = refused(
        "i=0; while [ $i -lt 400 ]; do printf 'täglich ' >&2; i=$((i+1)); done; printf 'and then it ended' >&2; exit 1",
    );
    let complaint = sentence.split_once(":\n").unwrap().1;
    assert!(complaint.ends_with("täglich and then it ended"), "{complaint}");
    assert!((990..=1000).contains(&complaint.len()), "{}", complaint.len());
    assert!(!complaint.contains('\u{fffd}'));
}

/// Who drops a program without stopping it, because a test failed, say, leaves no process behind.
#[test]
fn a_dropped_program_is_ended() {
    let answers = Answers::new("dropped");
    let file = answers.folder.join("pid");
    let mut process = script(&format!("echo $$ > '{}'; {READY} exec sleep 20", file.display()));
    process.start().unwrap();
    let pid = std::fs::read_to_string(&file).unwrap().trim().to_owned();
    let is_there = || {
        Command::new("/bin/kill")
            .args(["-0", &pid])
            .output()
            .unwrap()
            .status
            .success()
    };
    assert!(is_there());
    drop(process);
    assert!(!is_there(), "process {pid} goes on");
}

#[test]
fn a_program_that_does_not_read_is_stopped_in_time() {
    // The longest problem is more than a pipe holds.
    let longest = case::all()
        .unwrap()
        .iter()
        .max_by_key(|case| case.problem_text.len())
        .unwrap();
    let start = Instant::now();
    let mut process = script("echo '{\"type\":\"ready\"}'; exec sleep 20");
    let report = verdict_on(&mut process, &[&longest.problem.id]).unwrap();
    assert_eq!(report.cases[0].outcome, timed_out());
    assert!(start.elapsed() < Duration::from_secs(8));
}

#[test]
fn a_program_that_floods_is_stopped_in_time() {
    for flood in [
        "exec yes",
        "exec yes '{\"type\":\"answer\",\"id\":\"update.kalman\",\"steps\":[]}'",
    ] {
        let start = Instant::now();
        let report = verdict_on(&mut script(&format!("{READY} {flood}")), &THREE[..2]).unwrap();
        assert!(report.is_wrong());
        assert!(
            report.cases.iter().all(|case| case.outcome.is_wrong()),
            "{:?}",
            report.cases
        );
        assert!(
            start.elapsed() < Duration::from_secs(15),
            "{flood}: {:?}",
            start.elapsed()
        );
        assert!(
            report.remarks.len() < 10,
            "the same remark is made once: {:?}",
            report.remarks
        );
    }
}

/// A script that keeps a count: what it answers the second time is another thing.
#[test]
fn a_program_is_asked_its_first_case_again_in_the_same_process() {
    let answers = Answers::new("again");
    let cat = answers.cat("update.kalman");
    for (again, is_wrong) in [
        (cat.as_str(), false),
        ("echo '{\"id\":\"update.kalman\",\"steps\":[]}'", true),
    ] {
        let once = format!("if [ $asked ]; then {again}; else asked=1; {cat}; fi");
        let report = verdict(&answers.script(&[("update.kalman", &once)]));
        assert_others_are_right(&report, "");
        assert_eq!(
            (report.is_wrong(), report.observations.len()),
            (is_wrong, usize::from(is_wrong))
        );
    }
}

/// What is wrong behind another problem is right in a process that has just been started.
#[test]
fn a_wrong_case_is_asked_alone_in_a_process_of_its_own() {
    let answers = Answers::new("alone");
    let cat = answers.cat("update.simplex-5");
    // The chain's 0.64 is 0.74 where anything was asked before.
    let other = format!("if [ $kept ]; then {cat} | sed 's/0\\.[0-9]/0.7/'; else {cat}; fi");
    let first = format!("kept=1; {}", answers.cat("update.kalman"));
    let report = verdict(&answers.script(&[("update.kalman", &first), ("update.simplex-5", &other)]));
    assert_eq!(of(&report, "update.simplex-5").outcome, Outcome::Wrong);
    let alone = Observation::RightAlone {
        ids: vec!["update.simplex-5".into()],
    };
    assert_eq!(report.observations, [alone]);
}

// Lines that are no answers

#[test]
fn lines_that_do_not_start_with_a_brace_are_passed_over() {
    let answers = Answers::new("chatter");
    let chatter = "echo 'loading'; echo; echo '[1, 2]'; printf 'degr\\351s\\n'; printf '\\000\\377\\n'";
    let cat = answers.cat("update.kalman");
    let script = answers.script(&[("update.kalman", &format!("{chatter}; {cat}"))]);
    let report = verdict(&format!("{chatter}; {script}"));
    assert!(!report.is_wrong(), "{report:?}");
    assert_eq!(report.remarks, Vec::<String>::new());
}

#[test]
fn a_line_that_starts_like_a_message_and_is_none_is_shown() {
    let answers = Answers::new("garbage");
    for (says, words) in [
        (
            "echo '{steps: 1}'",
            "not a message: key must be a string at line 1 column 2: {steps: 1}",
        ),
        ("printf '{\"id\": \"\\377\"}\\n'", "a line that is not UTF-8"),
        (
            "echo '{\"type\":\"answer\",\"id\":\"update.kalman\",\"step\":[]}'",
            "`step` is not a key of an answer",
        ),
        (
            "echo '{\"type\":\"done\",\"id\":\"update.kalman\"}'",
            "\"done\" is not the type of an answer",
        ),
        (
            "echo '{\"id\":\"update.kalman\",\"steps\":[{\"step\":2}]}'",
            "steps[0].step: is 2",
        ),
    ] {
        let report = verdict(&answers.script(&[("update.kalman", says)]));
        let sentence = broken_sentence(&report, "update.kalman");
        assert!(sentence.contains(words), "{words} in {sentence}");
        assert_others_are_right(&report, "update.kalman");
    }
}

#[test]
fn a_line_of_a_hundred_megabytes_is_not_read() {
    let answers = Answers::new("long line");
    let says = "printf '{'; head -c 100000000 /dev/zero | tr '\\000' 'a'; echo";
    let report = verdict(&answers.script(&[("update.kalman", says)]));
    let sentence = broken_sentence(&report, "update.kalman");
    assert!(sentence.contains("a line longer than 16777216 bytes"), "{sentence}");
    assert_others_are_right(&report, "update.kalman");
}

/// Long words were once read letter by letter, each time to their end.
#[test]
fn a_line_of_megabytes_is_read_in_time() {
    let answers = Answers::new("long word");
    for byte in ["a", "-", "0", "[", "\""] {
        let says = format!("printf '{{\"id\":'; head -c 3000000 /dev/zero | tr '\\000' '{byte}'; echo '}}'");
        let report = verdict(&answers.script(&[("update.kalman", &says)]));
        let outcome = &of(&report, "update.kalman").outcome;
        assert!(
            matches!(outcome, Outcome::Broken(Broken::Garbage { .. })),
            "{byte}: {outcome:?}"
        );
        assert_others_are_right(&report, "update.kalman");
    }
}

#[test]
fn an_answer_to_another_case_is_no_answer() {
    let answers = Answers::new("another");
    let report = verdict(&answers.script(&[("update.kalman", "echo '{\"type\":\"answer\",\"id\":\"no.such\"}'")]));
    assert_eq!(
        broken_sentence(&report, "update.kalman"),
        "asked for `update.kalman`, answered `no.such`"
    );
    assert_others_are_right(&report, "update.kalman");
    let report = verdict(&answers.script(&[("update.kalman", "echo '{\"type\":\"answer\",\"steps\":[]}'")]));
    assert_eq!(
        broken_sentence(&report, "update.kalman"),
        "asked for `update.kalman`, answered ``"
    );
}

#[test]
fn an_answer_that_comes_twice_is_remarked_upon() {
    let answers = Answers::new("twice");
    let cat = answers.cat("update.cubature-3");
    let report = verdict(&answers.script(&[("update.cubature-3", &format!("{cat}; {cat}; {cat}"))]));
    assert!(!report.is_wrong(), "{report:?}");
    assert_eq!(report.remarks, ["answered `update.cubature-3` late or more than once"]);
}

/// One line too many, then the right one: the cases after it must not be answered with the answers to those before.
#[test]
fn one_line_too_many_does_not_shift_the_answers() {
    let answers = Answers::new("shifted");
    let cat = answers.cat("update.kalman");
    let report = verdict(&answers.script(&[("update.kalman", &format!("echo '{{debug}}'; {cat}"))]));
    assert!(broken_sentence(&report, "update.kalman").contains("{debug}"));
    assert_others_are_right(&report, "update.kalman");
    assert_eq!(report.remarks, ["answered `update.kalman` late or more than once"]);
}

#[test]
fn what_is_said_after_the_end_is_remarked_upon() {
    let answers = Answers::new("after the end");
    let script = format!(
        "{} echo bye; echo '{{\"type\":\"answer\"}}'; exit 0",
        answers.script(&[])
    );
    let report = verdict(&script);
    assert!(!report.is_wrong(), "{report:?}");
    assert_eq!(
        report.remarks,
        ["said more than it was asked for: {\"type\":\"answer\"}"]
    );
    // Of many remarks a hundred are kept.
    let many = "i=0; while [ $i -lt 150 ]; do echo \"{\\\"number\\\":$i}\"; i=$((i+1)); done; exit 0";
    let report = verdict(&format!("{} {many}", answers.script(&[])));
    assert_eq!(report.remarks.len(), 100);
    assert_eq!(report.remarks[99], "said more than it was asked for: {\"number\":99}");
    // Without end: no more than is kept, and not for ever.
    let start = Instant::now();
    let report = verdict(&format!("{} exec yes '{{}}'", answers.script(&[])));
    assert_eq!(report.remarks, ["said more than it was asked for: {}"]);
    assert!(start.elapsed() < Duration::from_secs(8));
}

#[test]
fn a_program_that_ignores_the_end_is_ended() {
    let answers = Answers::new("no end");
    let start = Instant::now();
    let report = verdict(&format!("{} exec sleep 20", answers.script(&[])));
    assert!(!report.is_wrong(), "{report:?}");
    assert!(start.elapsed() < Duration::from_secs(8));
}

// What answers mean

#[test]
fn a_filter_that_is_right_is_called_right() {
    for level in Level::ALL {
        let mut own = Planted {
            variants: Vec::new(),
            level,
        };
        let report = verdict_on(&mut own, &THREE).unwrap();
        assert!(!report.is_wrong());
        assert_eq!(report.echo, Some(true));
        assert!(report.cases.iter().all(|case| case.outcome == Outcome::Right));
        let (judged, of): (usize, usize) = report
            .cases
            .iter()
            .fold((0, 0), |sum, case| (sum.0 + case.judged, sum.1 + case.of));
        assert_eq!(judged == of, level == Level::Everything, "{level:?}: {judged} of {of}");
        assert_eq!(report.hidden.is_empty(), level == Level::Everything);
        assert_eq!(report.diagnosis, Diagnosis::Nothing);
    }
}

#[test]
fn a_wrong_echo_is_wrong_though_every_value_is_right() {
    let echoed = |echo: Option<Vec<f64>>| {
        let mut double = Double::new(right);
        double.ready.echo = echo;
        let report = verdict_on(&mut double, &["update.kalman"]).unwrap();
        assert_eq!(report.cases[0].outcome, Outcome::Right);
        (report.echo, report.is_wrong())
    };
    assert_eq!(echoed(Some(vec![321.0, 754.0])), (Some(true), false));
    // The matrix read by columns.
    assert_eq!(echoed(Some(vec![531.0, 742.0])), (Some(false), true));
    assert_eq!(echoed(Some(vec![321.0])), (Some(false), true));
    assert_eq!(echoed(Some(vec![f64::NAN, 754.0])), (Some(false), true));
    assert_eq!(echoed(Some(Vec::new())), (Some(false), true));
    assert_eq!(echoed(None), (None, false));
}

#[test]
fn only_the_filters_that_a_program_has_are_asked_for() {
    let mut double = Double::new(right);
    double.ready.kinds = Some(vec!["kalman".into(), "simplex-5".into(), "extended".into()]);
    let report = verdict_on(&mut double, &THREE).unwrap();
    assert_eq!(sorted(&double.asked), ["update.kalman", "update.simplex-5"]);
    assert_eq!((report.cases.len(), not_asked(&report)), (2, 1));
    let mut double = Double::new(right);
    double.ready.kinds = Some(Vec::new());
    let report = verdict_on(&mut double, &THREE).unwrap();
    assert!(double.asked.is_empty() && not_asked(&report) == 3);
}

/// A name that is misspelt would ask nothing, and nobody would know.
#[test]
fn a_kind_or_format_that_does_not_exist_is_refused() {
    let refused = |kinds: &[&str], formats: &[&str]| {
        let mut double = Double::new(right);
        double.ready.kinds = Some(kinds.iter().map(|&name| name.into()).collect());
        double.ready.formats = Some(formats.iter().map(|&name| name.into()).collect());
        verdict_on(&mut double, &THREE).unwrap_err().to_string()
    };
    assert_eq!(
        refused(&["kalmann"], &["immaculate-problem/1"]),
        "the program declares the kind of filter \"kalmann\", which does not exist; the nearest is `kalman`"
    );
    assert_eq!(
        refused(&["kalman", "particle"], &["immaculate-problem/1"]),
        "the program declares the kind of filter \"particle\", which does not exist"
    );
    assert_eq!(
        refused(&["kalman"], &["immaculate-problem/3"]),
        "the program declares the format \"immaculate-problem/3\", which does not exist; the nearest is `immaculate-problem/1`"
    );
}

/// Who says nothing of formats was written for the first one, and is not asked for what it cannot read.
#[test]
fn only_the_formats_that_a_program_reads_are_asked_for() {
    let asked = |message: Value| {
        let mut double = Double::new(right);
        double.ready = Ready::read(&message).unwrap();
        verdict_on(&mut double, &["update.kalman", "extended.one-mode"]).unwrap();
        sorted(&double.asked).join(" ")
    };
    assert_eq!(asked(json!({ "type": "ready" })), "update.kalman");
    let both = json!({ "formats": ["immaculate-problem/1", "immaculate-problem/2"] });
    assert_eq!(asked(both), "extended.one-mode update.kalman");
}

#[test]
fn a_program_that_leaves_validation_to_its_caller_is_not_asked_for_it() {
    let mut double = Double::new(right);
    double.ready.validates = false;
    let report = verdict_on(&mut double, &["rejected.", "update.kalman"]).unwrap();
    assert_eq!(sorted(&double.asked), ["update.kalman"]);
    assert!(not_asked(&report) >= 10 && !report.is_wrong());
    let mut double = Double::new(right);
    let report = verdict_on(&mut double, &["rejected."]).unwrap();
    assert!(report.cases.len() >= 10 && not_asked(&report) == 0);
    let rejected = Outcome::Rejected { other_class: None };
    assert!(
        report.cases.iter().all(|case| case.outcome == rejected),
        "{:?}",
        report.cases
    );
}

#[test]
fn a_problem_that_must_be_rejected_must_be_rejected() {
    let outcome = |answer: fn(&ProblemFile) -> Answer| {
        let report = verdict_on(&mut Double::new(answer), &["rejected.shape.matrix"]).unwrap();
        (report.cases[0].outcome.clone(), report.is_wrong())
    };
    let (found, is_wrong) = outcome(nothing);
    assert_eq!((found, is_wrong), (Outcome::NotRejected, true));
    // Values of another shape than the problem's are values all the same.
    let (found, is_wrong) =
        outcome(
            |_| match Trace::from_json(&json!([{ "step": 1, "combined": { "mean": [1] } }]), &SMALL) {
                Err(invalid) => Answer::Broken(Broken::Invalid(invalid)),
                Ok(_) => unreachable!(),
            },
        );
    assert_eq!((found, is_wrong), (Outcome::NotRejected, true));
    let (found, is_wrong) = outcome(|_| rejected("not-symmetric"));
    let expected = Outcome::Rejected {
        other_class: Some("not-symmetric".into()),
    };
    assert_eq!((found, is_wrong), (expected, false), "another class is no mistake");
    let (found, is_wrong) = outcome(|_| rejected("shape"));
    assert_eq!((found, is_wrong), (Outcome::Rejected { other_class: None }, false));
    let (found, is_wrong) = outcome(|_| skipped());
    assert_eq!((found, is_wrong), (skipped_outcome(), false));
    let (_, is_wrong) = outcome(|_| Answer::Broken(Broken::NotStarted("gone".into())));
    assert!(is_wrong, "a crash is no rejection");
}

/// A program that leaves checks to its caller and does not say so is reported once.
#[test]
fn problems_that_are_all_run_though_they_must_be_rejected_are_said_once() {
    let text_on = |answer: fn(&ProblemFile) -> Answer| {
        let report = verdict_on(&mut Double::new(answer), &["rejected."]).unwrap();
        assert!(report.is_wrong() && report.cases.len() > 10);
        immaculate::report::check::text(&report)
    };
    let text = text_on(|_| shows(Trace::empty(&SMALL)));
    assert_eq!(text.matches("NOT REJECTED").count(), 1, "{text}");
    assert!(
        text.contains("`\"validates\": false`") && !text.contains("rejected.shape"),
        "{text}"
    );
    let text = text_on(|problem| match problem.id.as_str() {
        "rejected.shape.matrix" => rejected("shape"),
        _ => shows(Trace::empty(&SMALL)),
    });
    assert!(
        text.matches("NOT REJECTED").count() > 9 && !text.contains("validates"),
        "{text}"
    );
}

#[test]
fn a_good_problem_must_not_be_rejected() {
    let report = verdict_on(&mut Double::new(|_| rejected("shape")), &["update.kalman"]).unwrap();
    let expected = Outcome::WronglyRejected {
        reason: "because".into(),
    };
    assert_eq!(report.cases[0].outcome, expected);
    assert!(report.is_wrong());
}

#[test]
fn what_is_skipped_is_neither_right_nor_wrong() {
    let report = verdict_on(&mut Double::new(|_| skipped()), &THREE).unwrap();
    assert!(!report.is_wrong());
    assert!(
        report
            .cases
            .iter()
            .all(|case| case.outcome == skipped_outcome() && case.judged == 0)
    );
    assert!(immaculate::report::check::text(&report).contains("NOTHING JUDGED"));
}

#[test]
fn an_answer_without_values_is_wrong() {
    let report = verdict_on(&mut Double::new(nothing), &["update.kalman"]).unwrap();
    assert_eq!(report.cases[0].outcome, Outcome::NothingShown);
    assert!(report.is_wrong());
}

#[test]
fn a_program_that_stops_before_the_end_is_wrong_and_its_steps_are_judged() {
    let first_steps = |error: Option<&'static str>, answer: fn(&ProblemFile) -> Answer| {
        let mut double = Double::new(answer);
        double.error = error.map(str::to_owned);
        double.steps = 1;
        let report = verdict_on(&mut double, &["steps.kalman"]).unwrap();
        assert!(report.cases[0].judged * 2 < report.cases[0].of, "one step of three");
        assert!(report.cases[0].judged > 20);
        report
    };
    let report = first_steps(Some("step 2: singular matrix"), right);
    let expected = Outcome::Stopped {
        reason: "step 2: singular matrix".into(),
    };
    assert_eq!(report.cases[0].outcome, expected);
    assert!(report.is_wrong());
    // Steps that are not shown are hidden, not wrong; the report says how many values were judged.
    let report = first_steps(None, right);
    assert_eq!(report.cases[0].outcome, Outcome::Right);
}

#[test]
fn another_convention_excuses_neither_an_early_end_nor_what_is_not_finite() {
    let verdict = |answer, error: Option<&str>| {
        let mut double = Double::new(answer);
        double.error = error.map(str::to_owned);
        let report = verdict_on(&mut double, &["update.kalman"]).unwrap();
        assert_eq!(report.cases[0].outcome, Outcome::Wrong);
        report
    };
    let report = verdict(without_two_pi, None);
    let is_convention =
        matches!(&report.diagnosis, Diagnosis::One(variants) if variants[0].id == "log-likelihood-without-two-pi");
    assert!(is_convention && !report.is_wrong(), "{:?}", report.diagnosis);
    assert!(verdict(not_finite_without_two_pi, None).is_wrong());
    let report = verdict(without_two_pi, Some("step 2: singular matrix"));
    assert!(report.is_wrong());
    let text = immaculate::report::check::text(&report);
    assert!(
        text.contains("the program stopped before the end: step 2: singular matrix"),
        "{text}"
    );
}

#[test]
fn a_value_that_is_not_finite_is_wrong_where_it_stands() {
    let answers = Answers::new("not finite");
    let path = answers.folder.join("update.kalman.json");
    let text = std::fs::read_to_string(&path).unwrap();
    for word in ["NaN", "null"] {
        let start = text.find("\"innovation\":[").unwrap() + "\"innovation\":[".len();
        let end = start + text[start..].find(',').unwrap();
        std::fs::write(&path, format!("{}{word}{}", &text[..start], &text[end..])).unwrap();
        let report = verdict(&answers.script(&[]));
        let (case, judged) = report.faults().next().unwrap();
        assert_eq!(case.id, "update.kalman");
        assert_eq!(judged.finding, Finding::NotFinite, "{word}");
        assert_eq!(judged.place, (1, Quantity::Innovation, 0), "{word}");
        assert_eq!(report.faults().count(), 1, "what follows is not blamed");
        assert_others_are_right(&report, "update.kalman");
        assert!(immaculate::report::check::text(&report).contains("the value is not finite"));
    }
}

#[test]
fn a_value_at_a_missed_detection_is_stale() {
    let report = verdict_on(&mut Double::new(stale), &["missed.one"]).unwrap();
    let judgement = report.cases[0].judgement.as_ref().unwrap();
    let found: Vec<_> = judgement
        .values
        .iter()
        .filter(|value| value.finding == Finding::Stale)
        .collect();
    assert!(
        !found.is_empty() && found.iter().all(|value| value.place.1 == Quantity::LogLikelihood),
        "{found:?}"
    );
}

/// A filter in Rust can build what no file can say.
#[test]
fn a_trace_of_other_dimensions_is_refused() {
    let other: [fn(&ProblemFile) -> Answer; 3] = [
        |problem| {
            let mut dimensions = problem.dimensions();
            dimensions.n += 1;
            shows(Trace::empty(&dimensions))
        },
        |problem| {
            let mut trace = Trace::empty(&problem.dimensions());
            trace.set(1, Quantity::CombinedMean, 0, vec![0.0; 3]);
            shows(trace)
        },
        |problem| {
            let mut trace = Trace::empty(&problem.dimensions());
            trace.set(1, Quantity::LogLikelihood, 0, Vec::new());
            shows(trace)
        },
    ];
    for answer in other {
        let report = verdict_on(&mut Double::new(answer), &["update.kalman"]).unwrap();
        let outcome = &report.cases[0].outcome;
        assert!(
            matches!(outcome, Outcome::Broken(Broken::Invalid(invalid)) if invalid.class == Class::Shape),
            "{outcome:?}"
        );
    }
}

#[test]
fn the_error_of_an_answer_may_be_said_in_many_ways() {
    for (error, expected) in [
        (json!("singular"), Some("singular")),
        (json!(5), Some("5")),
        (json!({ "code": 5 }), Some("{\"code\":5}")),
        (json!(true), Some("true")),
        (json!(["singular"]), Some("[\"singular\"]")),
        (json!(null), None),
        (json!(""), None),
        (json!([]), None),
        (json!({}), None),
        (json!(false), None),
    ] {
        let message = json!({ "type": "answer", "id": "x", "steps": [], "error": error });
        let Ok(Answer::Steps { error: found, .. }) = read_answer(&message, &SMALL) else {
            panic!("{message}");
        };
        assert_eq!(found.as_deref(), expected, "{message}");
    }
}

#[test]
fn a_ready_message_is_read_with_patience_and_no_more() {
    let read = |message: Value| Ready::read(&message);
    let default = Ready {
        formats: Some(vec!["immaculate-problem/1".into()]),
        ..Ready::default()
    };
    assert_eq!(read(json!({ "type": "ready" })), Ok(default.clone()));
    assert_eq!(
        read(
            json!({ "name": null, "kinds": null, "conventions": [], "echo": null, "validates": null, "precision": null })
        ),
        Ok(default)
    );
    let precision = |value: Value| read(json!({ "precision": value })).map(|ready| ready.precision);
    assert_eq!(precision(json!("single")), Ok(Precision::Single));
    assert_eq!(
        precision(json!({ "decimal_digits": 7 })),
        Ok(Precision::DecimalDigits(7))
    );
    for echo in [json!([321, 754]), json!([[321], [754]]), json!([[321.0, 754.0]])] {
        assert_eq!(read(json!({ "echo": echo })).unwrap().echo, Some(vec![321.0, 754.0]));
    }
    for (message, words) in [
        (json!([]), "not an object"),
        (json!({ "name": 1 }), "`name` is not a string"),
        (json!({ "precision": 53 }), "decimal_digits"),
        (json!({ "precision": { "decimal_digits": 1 } }), "from 2 to 15"),
        (json!({ "precision": { "decimal_digits": 1e9 } }), "from 2 to 15"),
        (json!({ "conventions": "none" }), "`conventions` is not an object"),
        (
            json!({ "conventions": { "first_step": 1 } }),
            "convention `first_step` is not a string",
        ),
        (json!({ "kinds": "kalman" }), "`kinds` is not a list"),
        (json!({ "kinds": [1] }), "not a string"),
        (json!({ "formats": 2 }), "`formats` is not a list"),
        (json!({ "echo": 321 }), "`echo` is not a list"),
        (json!({ "validates": "no" }), "`validates` is not true or false"),
    ] {
        let sentence = read(message.clone()).unwrap_err();
        assert!(sentence.contains(words), "{message}: {sentence}");
    }
}

// Folders of answers

#[test]
fn answers_in_files_are_judged_like_those_of_a_program() {
    let answers = Answers::new("files");
    let folder = &answers.folder;
    std::fs::remove_file(folder.join("update.simplex-5.json")).unwrap();
    let csv = succeeds(&["trace", "update.cubature-3", "--csv"]);
    std::fs::remove_file(folder.join("update.cubature-3.json")).unwrap();
    std::fs::write(folder.join("update.cubature-3.csv"), csv).unwrap();
    let ready = "{\"name\":\"from files\",\"precision\":\"double\",\"echo\":[321,754]}";
    // A folder that does not introduce itself is called by its name.
    let nameless = Folder { path: folder.clone() }.start().unwrap();
    assert_eq!(nameless.name, folder.display().to_string());
    std::fs::write(folder.join("ready.json"), ready).unwrap();
    let report = verdict_on(&mut Folder { path: folder.clone() }, &THREE).unwrap();
    assert_eq!(report.ready.name, "from files");
    for (id, outcome) in [
        ("update.kalman", Outcome::Right),
        ("update.cubature-3", Outcome::Right),
        (
            "update.simplex-5",
            Outcome::Skipped {
                reason: "there is no answer file".into(),
            },
        ),
    ] {
        assert_eq!(of(&report, id).outcome, outcome, "{id}");
    }
}

#[test]
fn an_answer_file_that_is_none_is_named() {
    let answers = Answers::new("bad files");
    let path = answers.folder.join("update.kalman.json");
    let good = std::fs::read_to_string(&path).unwrap();
    for (text, words) in [
        ("[1, 2".to_owned(), "EOF while parsing"),
        ("[]".into(), "an answer is an object"),
        (
            good.replace("update.kalman", "update.cubature-3"),
            "asked for `update.kalman`, answered `update.cubature-3`",
        ),
        (
            good.replace("\"steps\"", "\"results\""),
            "`results` is not a key of an answer",
        ),
    ] {
        std::fs::write(&path, text).unwrap();
        let report = verdict_on(
            &mut Folder {
                path: answers.folder.clone(),
            },
            &THREE,
        )
        .unwrap();
        let sentence = broken_sentence(&report, "update.kalman");
        assert!(sentence.contains(words), "{words} in {sentence}");
        assert_others_are_right(&report, "update.kalman");
    }
    std::fs::write(&path, [b'{', 0xff, b'}']).unwrap();
    let report = verdict_on(
        &mut Folder {
            path: answers.folder.clone(),
        },
        &THREE,
    )
    .unwrap();
    assert!(broken_sentence(&report, "update.kalman").contains("update.kalman.json: "));
}

#[test]
fn a_folder_that_cannot_be_used_is_named() {
    let answers = Answers::new("bad folder");
    let folder = answers.folder.clone();
    let nowhere = folder.join("nowhere");
    let sentence = verdict_on(&mut Folder { path: nowhere }, &THREE)
        .unwrap_err()
        .to_string();
    assert!(sentence.ends_with("nowhere is not a folder"), "{sentence}");
    for (ready, words) in [
        ("{", "EOF"),
        ("[]", "not an object"),
        ("{\"colour\":1}", "`colour` is not a key"),
    ] {
        std::fs::write(folder.join("ready.json"), ready).unwrap();
        let sentence = verdict_on(&mut Folder { path: folder.clone() }, &THREE)
            .unwrap_err()
            .to_string();
        assert!(
            sentence.contains("ready.json: ") && sentence.contains(words),
            "{sentence}"
        );
    }
}

// The other side

#[test]
fn the_other_side_answers_what_it_understands_and_nothing_else() {
    let mut own = Double::new(right);
    let Message::Reply(ready) = respond(&mut own, "{\"type\":\"start\"}") else {
        panic!("an answer");
    };
    let ready: Value = serde_json::from_str(&ready).unwrap();
    assert_eq!(ready["type"], "ready");
    assert_eq!(respond(&mut own, "{\"type\":\"stop\"}"), Message::Stop);
    for line in ["", "hello", "[]", "5", "{}", "{\"type\":\"pause\"}", "{\"type\":1}"] {
        assert!(matches!(respond(&mut own, line), Message::NotUnderstood(_)), "{line}");
    }
    for (problem, class) in [("null", "format"), ("{\"id\":\"x\"}", "format"), ("[]", "format")] {
        let Message::Reply(reply) = respond(&mut own, &format!("{{\"type\":\"run\",\"problem\":{problem}}}")) else {
            panic!("{problem}");
        };
        let reply: Value = serde_json::from_str(&reply).unwrap();
        assert_eq!(reply["type"], "rejected");
        if problem != "[]" {
            assert_eq!(reply["class"], class, "{reply}");
        }
    }
}

// The command line

#[test]
fn exit_statuses_are_those_of_the_help() {
    let own = env!("CARGO_BIN_EXE_immaculate");
    let kalman = ["check", "--case", "update.kalman", "--"];
    let status = |more: &[&str]| run(&[&kalman[..], more].concat()).status.code();
    assert_eq!(status(&[own, "answer"]), Some(0));
    assert_eq!(status(&[own, "answer", "--show", "combined"]), Some(0));
    assert_eq!(
        status(&[own, "answer", "--plant", "measurement-noise-omitted"]),
        Some(1)
    );
    assert_eq!(
        status(&["/bin/sh", "-c", "exit 0"]),
        Some(2),
        "a program that says nothing"
    );
    let strict = |more: &[&str]| {
        run(&[&["check", "--strict"], more, &["--", own, "answer"]].concat())
            .status
            .code()
    };
    assert_eq!(strict(&["--case", "update.kalman"]), Some(1), "much was not asked");
    assert_eq!(strict(&[]), Some(0), "this program meets everything");
    for (arguments, words) in [
        (&["check", "--strict"][..], "nothing to check"),
        (
            &["check", "--case", "no.such", "--", own, "answer"],
            "no case matches the selection",
        ),
        (
            &["check", "--case", "update.kalman", "--", "/no/such/program"],
            "cannot be started",
        ),
        (
            &["check", "python3", "filter.py", "--fast"],
            "put `--` before the program",
        ),
        (&["check", "--json", "./filter"], "put `--` before the program"),
        (&["check", "--answers", "/no/such/folder"], "is not a folder"),
        (&["check", "--answers", "x", "--", own], "cannot be used with"),
        (&["check", "--timeout", "0", "--", own], "'0'"),
        (&["check", "--", own, "answer", "--plant", "no-such"], "no-such"),
    ] {
        let output = run(arguments);
        let complaint = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {complaint}");
        assert!(
            complaint.contains(words) && !complaint.contains("panicked"),
            "{arguments:?}: {complaint}"
        );
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    let declares = "read -r line; echo '{\"type\":\"ready\",\"conventions\":{\"square_root\":\"qr\"}}'; sleep 1";
    let output = run(&[&kalman[..], &["/bin/sh", "-c", declares]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("declares `square_root`: \"qr\"")
    );
}

#[test]
fn the_verdict_can_be_selected_and_read_by_machines() {
    let own = env!("CARGO_BIN_EXE_immaculate");
    let ids = |selection: &[&str]| {
        let arguments = [&["check", "--json"], selection, &["--", own, "answer"]].concat();
        let report: Value = serde_json::from_str(&succeeds(&arguments)).unwrap();
        assert_eq!(report["format"], "immaculate-report/1");
        assert_eq!(report["wrong"], false);
        let cases = report["cases"].as_array().unwrap();
        cases
            .iter()
            .map(|case| case["id"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    let of_all = |has: &dyn Fn(&ProblemFile) -> bool| {
        let all = case::all().unwrap().iter().map(|case| &case.problem);
        all.filter(|problem| has(problem))
            .map(|problem| problem.id.clone())
            .collect::<Vec<_>>()
    };
    let update = of_all(&|problem| problem.id.starts_with("update.k") || problem.id.starts_with("missed.o"));
    assert_eq!(ids(&["--case", "update.k", "--case", "missed.o"]), update);
    assert_eq!(update.len(), 2);
    let missed =
        of_all(&|problem| problem.flags.contains(&"missed-detection".to_owned()) && problem.filter.name() == "kalman");
    assert!(!missed.is_empty());
    assert_eq!(ids(&["--flag", "missed-detection", "--kind", "kalman"]), missed);
    let text = succeeds(&["check", "--case", "update.kalman", "--", own, "answer"]);
    for words in [
        "update.kalman",
        "right",
        "COVERAGE",
        "RIGHT on what was judged: Immaculate",
    ] {
        assert!(text.contains(words), "{words} in\n{text}");
    }
}

/// Fixed gains are inputs, and shown all the same: the gain of another mode is seen in its own equation.
#[test]
fn the_fixed_gain_of_another_mode_is_named_with_its_equation() {
    let own = env!("CARGO_BIN_EXE_immaculate");
    let plant = ["--", own, "answer", "--plant", "gain-of-the-next-mode"];
    let output = run(&[&["check", "--case", "step.fixed-gain"], &plant[..]].concat());
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8(output.stdout).unwrap();
    for words in [
        "FAULT  gain  —  derbez2000, section 3, given",
        "step.fixed-gain, step 1, modes[0].gain[1][0] is 0.181, and should be 0.062",
        "gain-of-the-next-mode; mistake",
        "62 of 62 values",
    ] {
        assert!(text.contains(words), "{words} in\n{text}");
    }
    assert!(
        !text.contains("Never shown"),
        "what does not exist is not hidden:\n{text}"
    );
}

#[test]
fn two_mistakes_at_once_are_named() {
    let own = env!("CARGO_BIN_EXE_immaculate");
    let mistakes = ["mixed-spread-omitted", "combined-spread-omitted"];
    let plants = mistakes.map(|id| ["--plant", id]).concat();
    let arguments = [
        &["check", "--json", "--case", "step.n4-m2.two-modes", "--", own, "answer"],
        &plants[..],
    ]
    .concat();
    let output = run(&arguments);
    assert_eq!(output.status.code(), Some(1));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["wrong"], true);
    let diagnosis = report["diagnosis"].to_string();
    assert!(
        mistakes
            .iter()
            .all(|id| diagnosis.contains(&format!("\"id\":\"{id}\""))),
        "{diagnosis}"
    );
    assert!(!diagnosis.contains("\"unknown\""), "{diagnosis}");
}

// A program under test in this process

/// A filter that introduces itself and answers as instructed.
struct Double {
    ready: Ready,
    answer: fn(&ProblemFile) -> Answer,
    /// The number of steps of a right answer that are shown.
    steps: usize,
    error: Option<String>,
    asked: Vec<String>,
}

impl Double {
    fn new(answer: fn(&ProblemFile) -> Answer) -> Self {
        Self {
            ready: Ready::default(),
            answer,
            steps: usize::MAX,
            error: None,
            asked: Vec::new(),
        }
    }
}

impl Subject for Double {
    fn start(&mut self) -> Result<Ready, Broken> {
        Ok(self.ready.clone())
    }

    fn run(&mut self, problem: &ProblemFile) -> Answer {
        self.asked.push(problem.id.clone());
        let Answer::Steps { trace, error } = (self.answer)(problem) else {
            return (self.answer)(problem);
        };
        let mut shown = Trace::empty(&trace.dimensions);
        for (step, quantity, mode) in trace.all_places().filter(|place| place.0 <= self.steps) {
            if let Some(value) = trace.get(step, quantity, mode) {
                shown.set(step, quantity, mode, value.clone());
            }
        }
        Answer::Steps {
            trace: shown,
            error: self.error.clone().or(error),
        }
    }
}

static SMALL: LazyLock<Dimensions> = LazyLock::new(|| Dimensions::new(2, 1, 1, 1));

fn shows(trace: Trace) -> Answer {
    Answer::Steps { trace, error: None }
}

fn right(problem: &ProblemFile) -> Answer {
    let mut own = Planted {
        variants: Vec::new(),
        level: Level::Everything,
    };
    own.run(problem)
}

fn nothing(problem: &ProblemFile) -> Answer {
    shows(Trace::empty(&problem.dimensions()))
}

/// Right, with another convention that is not declared.
fn without_two_pi(problem: &ProblemFile) -> Answer {
    let mut own = Planted {
        variants: vec!["log-likelihood-without-two-pi".into()],
        level: Level::Everything,
    };
    own.run(problem)
}

/// The same, and one value that is not finite.
fn not_finite_without_two_pi(problem: &ProblemFile) -> Answer {
    let Answer::Steps { mut trace, error } = without_two_pi(problem) else {
        panic!("{}", problem.id);
    };
    trace.set(1, Quantity::CombinedMean, 0, vec![f64::NAN; problem.state.len()]);
    Answer::Steps { trace, error }
}

/// A likelihood where nothing was measured.
fn stale(problem: &ProblemFile) -> Answer {
    let Answer::Steps { mut trace, error } = right(problem) else {
        panic!("{}", problem.id);
    };
    for entry in problem.measurements.iter().filter(|entry| entry.z.is_none()) {
        trace.set(entry.step, Quantity::LogLikelihood, 0, vec![-1.0]);
    }
    Answer::Steps { trace, error }
}

fn rejected(class: &str) -> Answer {
    Answer::Rejected {
        class: class.into(),
        reason: "because".into(),
    }
}

fn skipped() -> Answer {
    Answer::Skipped {
        reason: "no time".into(),
    }
}

fn skipped_outcome() -> Outcome {
    Outcome::Skipped {
        reason: "no time".into(),
    }
}

// Programs under test as scripts

/// The right answers to three cases, a file each, in a folder of a test's own.
struct Answers {
    folder: PathBuf,
}

impl Answers {
    fn new(name: &str) -> Self {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("protocol").join(name);
        // What an earlier run left, if it left anything.
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        for id in THREE {
            let case = case::all().unwrap().iter().find(|case| case.problem.id == id).unwrap();
            let line = json!({ "type": "run", "problem": case.problem }).to_string();
            let Message::Reply(reply) = respond(&mut Double::new(right), &line) else {
                panic!("{id}");
            };
            std::fs::write(folder.join(format!("{id}.json")), format!("{reply}\n")).unwrap();
        }
        Self { folder }
    }

    /// The command that answers to a case rightly.
    fn cat(&self, id: &str) -> String {
        format!("cat '{}'", self.folder.join(format!("{id}.json")).display())
    }

    /// A script that answers all three cases rightly, but these by other commands; it goes on behind the end of the check.
    fn script(&self, others: &[(&str, &str)]) -> String {
        let answers = THREE.map(|id| {
            let other = others.iter().find(|(other, _)| *other == id);
            let command = other.map_or_else(|| self.cat(id), |(_, command)| (*command).to_owned());
            format!("*'\"id\":\"{id}\"'*) {command};;")
        });
        format!(
            "{READY} while read -r line; do case \"$line\" in *'\"type\":\"stop\"'*) break;; {} esac; done;",
            answers.join(" ")
        )
    }
}

fn script(text: &str) -> Process {
    let command = ["/bin/sh", "-c", text].map(str::to_owned).to_vec();
    Process::new(command, LIMIT).ready_within(LIMIT)
}

fn verdict_on(subject: &mut dyn Subject, ids: &[&str]) -> Result<Report, NotMade> {
    let selection = Selection {
        ids: ids.iter().map(|id| (*id).to_owned()).collect(),
        ..Selection::default()
    };
    check(subject, &selection, &|_| ())
}

/// The verdict on a script over three cases.
fn verdict(text: &str) -> Report {
    verdict_on(&mut script(text), &THREE).unwrap()
}

/// The sentence with which a script is refused.
fn refused(text: &str) -> String {
    verdict_on(&mut script(text), &["update.kalman"])
        .unwrap_err()
        .to_string()
}

/// How many of the selected cases were not asked.
fn not_asked(report: &Report) -> usize {
    report
        .not_asked
        .iter()
        .filter(|case| case.why != Unasked::Selection)
        .count()
}

fn of<'a>(report: &'a Report, id: &str) -> &'a CaseReport {
    report.cases.iter().find(|case| case.id == id).unwrap()
}

fn timed_out() -> Outcome {
    Outcome::Broken(Broken::TimedOut {
        seconds: 1,
        hint: String::new(),
    })
}

fn broken_sentence(report: &Report, id: &str) -> String {
    assert!(report.is_wrong());
    match &of(report, id).outcome {
        Outcome::Broken(broken) => broken.to_string(),
        outcome => panic!("{id}: {outcome:?}"),
    }
}

fn assert_others_are_right(report: &Report, id: &str) {
    assert_eq!(report.cases.len(), 3);
    for case in report.cases.iter().filter(|case| case.id != id) {
        assert_eq!(case.outcome, Outcome::Right, "{}", case.id);
    }
}

/// The ids that were asked, each once: the first case is asked again.
fn sorted(ids: &[String]) -> Vec<String> {
    let mut ids = ids.to_vec();
    ids.sort();
    ids.dedup();
    ids
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn run(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_immaculate"));
    command.args(arguments).output().unwrap()
}

fn succeeds(arguments: &[&str]) -> String {
    let output = run(arguments);
    let complaint = String::from_utf8(output.stderr).unwrap();
    assert!(
        output.status.success() && complaint.is_empty(),
        "{arguments:?}: {complaint}"
    );
    String::from_utf8(output.stdout).unwrap()
}
