//! Goal: whatever interrupts the program, a file is the old one or the new one as a whole, and what cannot be written is named in a
//! sentence with the documented exit status.
//!
//! Method: a writer is killed again and again while it writes megabytes; disks are full, directories missing, in the way or read-only,
//! files limited in size, pipes closed. What a machine does not offer (a file system of its own, a terminal, being somebody else than root)
//! is skipped with a line that says so. Kind of evidence: measured, and exact where sentences are compared.

#![cfg(target_os = "linux")]

mod common;

use common::program::{self, error_of, names};
use immaculate::file;
use immaculate::oracle::case;
use std::io::{BufRead, BufReader, Read};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

// Killed

/// Where the writer of the next test writes; without it there is nothing to write.
const PLACE: &str = "IMMACULATE_PLACE_OF_THE_WRITER";

/// So much is written at a time: a kill meets a write in the middle more often than not.
const MEGABYTES: usize = 4;

/// The other side of the next test, a process of its own that writes until it is killed.
#[test]
fn a_writer_that_never_ends() {
    let Ok(place) = std::env::var(PLACE) else { return };
    let texts = ["a", "b"].map(|letter| letter.repeat(MEGABYTES << 20));
    println!("writing");
    loop {
        for text in &texts {
            file::write(Path::new(&place), text).unwrap();
        }
    }
}

#[test]
fn writers_of_one_process_do_not_meet() {
    let folder = temporary("together");
    // Long enough that one is at work while the others begin.
    let content = |writer: usize| format!("{writer}\n").repeat(20_000);
    std::thread::scope(|scope| {
        for writer in 0..4 {
            let (folder, content) = (&folder, &content);
            scope.spawn(move || {
                for round in 0..10 {
                    file::write(&folder.join(format!("{writer}-{round}")), &content(writer)).unwrap();
                }
            });
        }
    });
    for writer in 0..4 {
        for round in 0..10 {
            let read = std::fs::read_to_string(folder.join(format!("{writer}-{round}"))).unwrap();
            assert!(read == content(writer), "{writer}, {round}");
        }
    }
    assert_eq!(names(&folder).len(), 40);
}

#[test]
fn a_file_whose_writer_is_killed_is_old_or_new() {
    let folder = temporary("killed");
    let place = folder.join("file");
    let mut left_over = 0;
    for round in 0..8 {
        let mut writer = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "a_writer_that_never_ends", "--nocapture"])
            .env(PLACE, &place)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let said = BufReader::new(writer.stdout.take().unwrap())
            .lines()
            .map_while(Result::ok);
        assert!(said.take(10).any(|line| line.contains("writing")), "the writer writes");
        std::thread::sleep(Duration::from_millis(3 + 7 * round % 60));
        writer.kill().unwrap();
        writer.wait().unwrap();
        if let Ok(bytes) = std::fs::read(&place) {
            assert_eq!(bytes.len(), MEGABYTES << 20, "round {round}: a whole file");
            assert!(bytes.iter().all(|byte| *byte == bytes[0]), "round {round}: one file");
        }
        for name in names(&folder).iter().filter(|name| *name != "file") {
            assert!(name.starts_with(".immaculate-"), "{name}");
            std::fs::remove_file(folder.join(name)).unwrap();
            left_over += 1;
        }
    }
    assert!(
        place.exists() && left_over > 0,
        "{left_over} kills met a write in the middle"
    );
}

/// The same with a command that writes several files: each by itself is old or new.
#[test]
fn copied_cases_are_old_or_new_when_the_copier_is_killed() {
    let folder = temporary("copier killed");
    let selection = ["--case", "step."];
    succeeds(&[&["cases", "copy", folder.to_str().unwrap()], &selection[..]].concat());
    let all: Vec<(PathBuf, Vec<u8>)> = names(&folder)
        .iter()
        .map(|name| (folder.join(name), std::fs::read(folder.join(name)).unwrap()))
        .collect();
    let (mut old, mut new) = (0, 0);
    for round in 0..8 {
        for (path, _) in &all {
            std::fs::write(path, "old").unwrap();
        }
        let mut copier = immaculate(&[&["cases", "copy", folder.to_str().unwrap()], &selection[..]].concat())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(5 + 6 * round));
        copier.kill().unwrap();
        copier.wait().unwrap();
        for (path, published) in &all {
            let bytes = std::fs::read(path).unwrap();
            let is_new = &bytes == published;
            assert!(is_new || bytes == b"old", "{}: {} bytes", path.display(), bytes.len());
            (old, new) = (old + u32::from(!is_new), new + u32::from(is_new));
        }
    }
    println!("{old} files were old, {new} new");
    assert!(old > 0, "no kill came before the end");
}

// What is in the way

/// Each command that writes, with a place that it cannot write to.
#[test]
fn what_cannot_be_written_is_named_and_leaves_nothing() {
    let folder = temporary("in the way");
    let text = folder.join("text");
    std::fs::write(&text, "old").unwrap();
    std::fs::create_dir(folder.join("directory")).unwrap();
    for (place, words) in [
        (folder.join("missing/file"), "No such file or directory"),
        (folder.join("directory"), "is a directory"),
        (text.join("below"), "Not a directory"),
        (folder.join("x".repeat(300)), "File name too long"),
    ] {
        let complaint = refuses(&["stability", "--certificate", place.to_str().unwrap()], 1);
        assert!(complaint.contains(place.to_str().unwrap()), "{complaint}");
        assert!(complaint.contains(words), "{complaint}");
    }
    for place in [text.clone(), text.join("below")] {
        let place = place.to_str().unwrap();
        for arguments in [
            &["cases", "copy", place, "--case", "update.kalman"][..],
            &["reproduce", "zhu2016", "--runs", "2", "--brief", "--out", place],
            &["reproduce", "sustika2015", "--sweep", "--runs", "2", "--out", place],
            &["stability", "--map", "--points", "2", "--out", place],
        ] {
            let complaint = refuses(arguments, 1);
            assert!(complaint.contains(place), "{arguments:?}: {complaint}");
        }
    }
    assert_eq!(names(&folder), ["directory", "text"]);
    assert_eq!(std::fs::read_to_string(&text).unwrap(), "old");
}

#[test]
fn a_read_only_directory_is_named() {
    let folder = temporary("read-only");
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o555)).unwrap();
    if std::fs::write(folder.join("as root"), "").is_ok() {
        println!("skipped: root writes into read-only directories, too");
        return;
    }
    let place = folder.join("certificate.json");
    let complaint = refuses(&["stability", "--certificate", place.to_str().unwrap()], 1);
    assert!(complaint.contains("Permission denied"), "{complaint}");
}

#[test]
fn links_and_permissions_stay_and_what_is_read_only_is_not_replaced() {
    let folder = temporary("links");
    let (real, link) = (folder.join("real"), folder.join("link"));
    std::fs::write(&real, "old").unwrap();
    std::fs::set_permissions(&real, std::fs::Permissions::from_mode(0o640)).unwrap();
    symlink("real", &link).unwrap();
    file::write(&link, "new").unwrap();
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(std::fs::read_to_string(&real).unwrap(), "new");
    assert_eq!(std::fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
    std::fs::set_permissions(&real, std::fs::Permissions::from_mode(0o444)).unwrap();
    let complaint = refuses(&["stability", "--certificate", link.to_str().unwrap()], 1);
    assert!(complaint.contains("link: is read-only"), "{complaint}");
    assert_eq!(std::fs::read_to_string(&real).unwrap(), "new");
    // A link that leads nowhere is a place like any other.
    let nowhere = folder.join("nowhere");
    symlink("no such file", &nowhere).unwrap();
    file::write(&nowhere, "new").unwrap();
    assert_eq!(std::fs::read_to_string(&nowhere).unwrap(), "new");
    assert_eq!(names(&folder), ["link", "nowhere", "real"]);
}

/// A pipe has nothing to be kept: what is written comes out of it, and it stays a pipe.
#[test]
fn a_pipe_is_written_to_and_not_replaced() {
    let folder = temporary("pipe");
    let pipe = folder.join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = Command::new("cat").arg(&pipe).stdout(Stdio::piped()).spawn().unwrap();
    file::write(&pipe, "through").unwrap();
    assert_eq!(reader.wait_with_output().unwrap().stdout, b"through");
    assert_eq!(names(&folder), ["pipe"]);
    assert!(!std::fs::metadata(&pipe).unwrap().is_file());
}

// No room

/// The shell limits the size of files, and the signal that tells of it is ignored: a write fails as on a full disk.
#[test]
fn a_file_that_may_not_grow_is_an_error_and_the_old_one_stays() {
    let folder = temporary("limited");
    let old = folder.join("step.cubature-5.trace.json");
    std::fs::write(&old, "old").unwrap();
    let copy = format!("\"$0\" cases copy '{}' --case step.cubature-5", folder.display());
    let output = shell(&format!("trap '' XFSZ; ulimit -f 1; exec {copy}"));
    let complaint = error_of(&output);
    assert_eq!(output.status.code(), Some(1), "{complaint}");
    assert!(
        complaint.starts_with("immaculate: ") && complaint.contains("File too large"),
        "{complaint}"
    );
    let is_part = |name: &String| name.starts_with(".immaculate-");
    assert!(!names(&folder).iter().any(is_part), "nothing is left over");
    assert_eq!(std::fs::read(&old).unwrap(), b"old");
    // Where the signal is not ignored it ends the program at once, as a kill does.
    let output = shell(&format!("ulimit -c 0; ulimit -f 1; exec {copy}"));
    assert_eq!(output.status.code(), None);
    assert_eq!(std::fs::read(&old).unwrap(), b"old");
}

/// A file system of 64 kB, mounted where nobody else sees it.
#[test]
fn a_full_file_system_is_an_error_and_the_old_file_stays() {
    let folder = temporary("full");
    let script = format!(
        "mount -t tmpfs -o size=64k none '{0}' || exit 77; cd '{0}'; printf old > kept; head -c 50000 /dev/zero > filler; \
         \"$0\" cases copy . --case steps.; echo $?; cat kept; ls -A | grep -c part",
        folder.display()
    );
    let output = Command::new("unshare")
        .args(["-rm", "/bin/sh", "-c", &script, env!("CARGO_BIN_EXE_immaculate")])
        .output();
    let Some(output) = output.ok().filter(|output| !output.stdout.is_empty()) else {
        println!("skipped: this machine does not let its users mount a file system");
        return;
    };
    assert_eq!(
        String::from_utf8(output.stdout.clone()).unwrap(),
        "1\nold0\n",
        "{}",
        error_of(&output)
    );
    assert!(
        error_of(&output).contains("No space left on device"),
        "{}",
        error_of(&output)
    );
}

/// Linux has a file that is always full. Help and version are output like any other.
#[test]
fn a_full_standard_output_is_an_error() {
    for arguments in [
        &["choices"][..],
        &["--help"],
        &["check", "--help"],
        &["--version"],
        &["cases", "list", "--json"],
        &["trace", "update.kalman"],
        &["cases", "schema", "trace"],
    ] {
        let full = std::fs::File::create("/dev/full").unwrap();
        let output = immaculate(arguments).stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert_eq!(
            error_of(&output),
            "immaculate: standard output: No space left on device (os error 28)\n",
            "{arguments:?}"
        );
    }
    let output = shell("echo '{\"type\":\"start\"}' | \"$0\" answer > /dev/full; echo $? >&2");
    assert!(
        error_of(&output).ends_with("(os error 28)\n1\n"),
        "{}",
        error_of(&output)
    );
    // Not even the complaint can be written: the status says it.
    for (script, status) in [
        ("exec \"$0\" choices x 2> /dev/full", 2),
        ("exec \"$0\" choices > /dev/full 2>&1", 1),
        ("exec \"$0\" prove 2> /dev/full", 2),
        ("exec \"$0\" choices >&- 2>&-", 0),
    ] {
        assert_eq!(shell(script).status.code(), Some(status), "{script}");
    }
}

// Nobody reads

#[test]
fn a_reader_that_goes_after_a_line_is_no_error() {
    let folder = temporary("long");
    let long = folder.join("long.json");
    std::fs::write(&long, long_problem(20_000)).unwrap();
    for arguments in [
        &["cases", "list"][..],
        &["cases", "list", "--json"],
        &["cases", "show", "steps.kalman", "--json"],
        &["trace", long.to_str().unwrap(), "--json"],
        &["trace", long.to_str().unwrap()],
        &["--help"],
    ] {
        let mut child = immaculate(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap())
            .read_line(&mut line)
            .unwrap();
        assert!(!line.is_empty(), "{arguments:?}");
        let mut complaint = String::new();
        child.stderr.take().unwrap().read_to_string(&mut complaint).unwrap();
        assert_eq!(complaint, "", "{arguments:?}");
        assert_eq!(child.wait().unwrap().code(), Some(0), "{arguments:?}");
    }
}

/// A program under test whose checker has gone does not answer for ever.
#[test]
fn answers_end_when_nobody_reads_them() {
    let output = shell("yes '{\"type\":\"start\"}' | timeout 60 \"$0\" answer | head -n 1");
    assert!(String::from_utf8_lossy(&output.stdout).contains("ready"));
    assert!(!error_of(&output).contains("panicked"), "{}", error_of(&output));
    let output = shell("(yes '{\"type\":\"start\"}' | timeout 60 \"$0\" answer; echo $? >&2) | head -n 1");
    assert!(error_of(&output).contains('0'), "{}", error_of(&output));
}

/// A terminal shows the bar while the reader of the output has gone.
#[test]
fn a_bar_without_a_reader_is_no_panic() {
    let command = format!(
        "{} reproduce zhu2016 --runs 50 --brief | true; {} cases verify --case update. | head -n 1",
        env!("CARGO_BIN_EXE_immaculate"),
        env!("CARGO_BIN_EXE_immaculate")
    );
    let Ok(output) = Command::new("script")
        .args(["-qec", &command, "/dev/null"])
        .stdin(Stdio::null())
        .output()
    else {
        println!("skipped: this machine has no `script`, which makes a terminal");
        return;
    };
    let shown = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(shown.contains("reproducing"), "the bar is there: {shown}");
    assert!(!shown.contains("panicked") && !shown.contains("immaculate:"), "{shown}");
}

// How the program is run

/// Many steps of the smallest problem.
fn long_problem(steps: usize) -> String {
    let all = case::all().unwrap();
    let small = all
        .iter()
        .find(|case| case.problem.id == "step.n1-m1.two-modes")
        .unwrap();
    let mut problem = small.problem.clone();
    let first = problem.measurements[0].clone();
    problem.measurements = (1..=steps)
        .map(|step| {
            let mut entry = first.clone();
            entry.step = step;
            entry
        })
        .collect();
    serde_json::json!(problem).to_string()
}

/// The program with nothing to read.
fn immaculate(arguments: &[&str]) -> Command {
    let mut command = program::immaculate(arguments);
    command.stdin(Stdio::null());
    command
}

fn shell(script: &str) -> Output {
    Command::new("/bin/sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_immaculate")])
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn succeeds(arguments: &[&str]) {
    let output = immaculate(arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", error_of(&output));
}

/// The complaint, a sentence, of a command that ends with this status.
fn refuses(arguments: &[&str], status: i32) -> String {
    let output = immaculate(arguments).output().unwrap();
    let complaint = error_of(&output);
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {complaint}");
    assert!(complaint.starts_with("immaculate: "), "{arguments:?}: {complaint}");
    assert!(!complaint.contains("panicked"), "{arguments:?}: {complaint}");
    complaint
}

/// An empty directory of this test's own.
fn temporary(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
        .join("interruption")
        .join(name);
    if folder.exists() {
        let _ = std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o755));
        std::fs::remove_dir_all(&folder).unwrap();
    }
    std::fs::create_dir_all(&folder).unwrap();
    folder
}
