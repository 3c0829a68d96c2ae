//! The journal of a sweep: its finished points, in a file, from which it goes on after an interruption.
//!
//! After this file the reader knows the format and what is promised of it. The file is comma-separated text: a line that names the format,
//! the seed, the number of runs and the choices; a line of column names; then one line a setting, in the order of the settings, written
//! and flushed as soon as the setting is finished. Numbers are the shortest decimals that are read back to the same double, so that a
//! sweep that was interrupted ends with the same bytes, and the same results to the bit, as one that was not.
//!
//! ```text
//! # immaculate-sweep/1; seed 1; runs 50; choices defaults
//! trajectory,parameter,value,runs_with_jump,cmkf_mean,…
//! straight,noise-density,0.01,12,1.8…,…
//! ```
//!
//! A last line without its end is what an interruption in the middle of writing leaves; it is dropped and its setting run again. Anything
//! else that is not as it would have been written is refused, in a sentence that names the file and what is wrong with it.

use super::sweep::{Fit, Point, Setting};
use crate::file;
use crate::statistics::Estimate;
use std::fmt::Write as _;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Error, Read, Seek, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

/// The format's name and version.
pub const FORMAT: &str = "immaculate-sweep/1";

/// What tells the journals of different sweeps apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Header {
    /// The seed of the random numbers.
    pub seed: u64,
    /// The number of runs at each setting.
    pub runs: usize,
    /// The choices that differ from the defaults, in words.
    pub choices: String,
}

impl Header {
    /// The first line, without its end.
    fn line(&self) -> String {
        let parts = self.parts().map(|(name, value)| format!("; {name} {value}"));
        format!("# {FORMAT}{}", parts.concat())
    }

    fn parts(&self) -> [(&'static str, String); 3] {
        [
            ("seed", self.seed.to_string()),
            ("runs", self.runs.to_string()),
            ("choices", self.choices.clone()),
        ]
    }
}

/// Why a file is not the journal that was asked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BadJournal {
    /// It cannot be opened, read or written.
    #[error("{file}: {cause}")]
    File {
        /// The file.
        file: String,
        /// Why.
        cause: String,
    },
    /// It is something else.
    #[error("{file}: this is no journal of a sweep, which begins with `# {FORMAT}`; remove it or write elsewhere")]
    NoJournal {
        /// The file.
        file: String,
    },
    /// It is the journal of another sweep.
    #[error(
        "{file}: this journal is of {what} {has}, and the sweep is of {what} {wanted}; remove it or write elsewhere"
    )]
    OtherSweep {
        /// The file.
        file: String,
        /// What differs.
        what: &'static str,
        /// As in the file.
        has: String,
        /// As asked for.
        wanted: String,
    },
    /// A line is not as it would have been written.
    #[error("{file}, line {line}: {cause}; remove the journal or write elsewhere")]
    Line {
        /// The file.
        file: String,
        /// The line, counted from 1.
        line: usize,
        /// What is wrong with it.
        cause: String,
    },
}

/// A journal that is open to be continued.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Opens a journal, or begins one where there is no file; and its points, which are those of the first settings.
    ///
    /// # Errors
    ///
    /// [`BadJournal`] when the file cannot be read or written, or is not a journal of this sweep.
    pub fn open(path: &Path, header: &Header, settings: &[Setting]) -> Result<(Self, Vec<Point>), BadJournal> {
        let name = path.display().to_string();
        let failed = |error: Error| failed(path, &error);
        let mut options = OpenOptions::new();
        let mut file = options
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        // Two sweeps that write by turns would spoil it for both.
        file.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => failed(Error::other("another sweep is writing this journal")),
            TryLockError::Error(error) => failed(error),
        })?;
        let mut bytes = Vec::new();
        (&file)
            .take(file::LONGEST_FILE)
            .read_to_end(&mut bytes)
            .map_err(failed)?;
        if bytes.len() as u64 == file::LONGEST_FILE {
            return Err(BadJournal::NoJournal { file: name });
        }
        let head = format!("{}\n{}\n", header.line(), columns());
        if head.as_bytes().starts_with(&bytes) {
            // Nothing yet, or a beginning that was torn.
            bytes.clear();
        }
        // What ends with a line's end was written as a whole.
        let complete = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
        let Ok(text) = std::str::from_utf8(&bytes[..complete]) else {
            return Err(BadJournal::NoJournal { file: name });
        };
        let points = if bytes.is_empty() {
            Vec::new()
        } else {
            read(&name, text, header, settings)?
        };
        file.set_len(complete as u64).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        let mut journal = Self {
            path: path.to_owned(),
            file,
        };
        if bytes.is_empty() {
            journal.write(&head)?;
        }
        Ok((journal, points))
    }

    /// Adds a finished setting.
    ///
    /// # Errors
    ///
    /// [`BadJournal`] when it cannot be written.
    pub fn append(&mut self, setting: &Setting, point: &Point) -> Result<(), BadJournal> {
        self.write(&format!("{}\n", line(setting, point)))
    }

    fn write(&mut self, text: &str) -> Result<(), BadJournal> {
        let written = self
            .file
            .write_all(text.as_bytes())
            .and_then(|()| self.file.sync_data());
        written.map_err(|error| failed(&self.path, &error))
    }
}

fn failed(path: &Path, error: &Error) -> BadJournal {
    BadJournal::File {
        file: path.display().to_string(),
        cause: error.to_string(),
    }
}

/// The points of a journal's text, all of whose lines are complete.
fn read(file: &str, text: &str, header: &Header, settings: &[Setting]) -> Result<Vec<Point>, BadJournal> {
    let mut lines = text.lines();
    check_header(file, lines.next().unwrap_or_default(), header)?;
    let bad = |line: usize, cause: String| BadJournal::Line {
        file: file.to_owned(),
        line,
        cause,
    };
    // A beginning that was torn is none of ours to be read: it was dropped before.
    let names = lines.next().unwrap_or_default();
    if names != columns() {
        return Err(bad(2, format!("the columns are `{names}` and not `{}`", columns())));
    }
    let mut points = Vec::new();
    for (number, line) in (3..).zip(lines) {
        let Some(setting) = settings.get(points.len()) else {
            return Err(bad(number, "there are more lines than settings".to_owned()));
        };
        points.push(parse(line, setting).map_err(|cause| bad(number, cause))?);
    }
    Ok(points)
}

/// The first line is that of this sweep; if not, what differs.
fn check_header(file: &str, line: &str, header: &Header) -> Result<(), BadJournal> {
    let no_journal = || BadJournal::NoJournal { file: file.to_owned() };
    let mut rest = line.strip_prefix(&format!("# {FORMAT}")).ok_or_else(no_journal)?;
    let parts = header.parts();
    for (index, (what, wanted)) in parts.iter().enumerate() {
        rest = rest.strip_prefix(&format!("; {what} ")).ok_or_else(no_journal)?;
        // The last part is the rest of the line, whatever is in it.
        let end = rest.find(';').filter(|_| index + 1 < parts.len()).unwrap_or(rest.len());
        let (has, after) = rest.split_at(end);
        if has != wanted {
            return Err(BadJournal::OtherSweep {
                file: file.to_owned(),
                what,
                has: has.to_owned(),
                wanted: wanted.clone(),
            });
        }
        rest = after;
    }
    Ok(())
}

/// The names of the columns.
pub fn columns() -> String {
    let mut names = String::from("trajectory,parameter,value,runs_with_jump");
    for filter in ["cmkf", "ukf", "plain_ukf"] {
        for what in [
            "mean",
            "standard_error",
            "median",
            "divergent",
            "divergent_with_jump",
            "failed",
        ] {
            let _ = write!(names, ",{filter}_{what}");
        }
    }
    for difference in ["ukf_minus_cmkf", "plain_ukf_minus_cmkf"] {
        let _ = write!(names, ",{difference},{difference}_standard_error");
    }
    names
}

/// A setting and its point as a line.
pub fn line(setting: &Setting, point: &Point) -> String {
    let mut line = format!("{},{}", setting_fields(setting), point.runs_with_jump);
    for fit in &point.fits {
        let Fit {
            mean,
            median,
            divergent,
            divergent_with_jump,
            failed,
        } = fit;
        let _ = write!(
            line,
            ",{:?},{:?},{median:?},{divergent},{divergent_with_jump},{failed}",
            mean.value, mean.standard_error
        );
    }
    for difference in [point.unscented_less_converted, point.plain_less_converted] {
        let _ = write!(line, ",{:?},{:?}", difference.value, difference.standard_error);
    }
    line
}

/// The fields that say which setting a line is of.
fn setting_fields(setting: &Setting) -> String {
    let (trajectory, parameter) = (setting.trajectory.name(), setting.parameter.name());
    format!("{trajectory},{parameter},{:?}", setting.value)
}

/// The point of a line, which must be of the given setting.
fn parse(line: &str, setting: &Setting) -> Result<Point, String> {
    let expected = setting_fields(setting);
    let rest = line.strip_prefix(&format!("{expected},"));
    let rest = rest.ok_or_else(|| format!("the setting `{expected}` is expected here, and this is `{line}`"))?;
    let mut fields = Fields(rest.split(','));
    let runs_with_jump = fields.count()?;
    let fits = [fields.fit()?, fields.fit()?, fields.fit()?];
    let point = Point {
        runs_with_jump,
        fits,
        unscented_less_converted: fields.estimate()?,
        plain_less_converted: fields.estimate()?,
    };
    match fields.0.next() {
        None if self::line(setting, &point) == line => Ok(point),
        None => Err("a number is not as this program writes it".to_owned()),
        Some(field) => Err(format!("`{field}` comes after the last column")),
    }
}

/// The fields of a line that are still to be read.
struct Fields<'a>(std::str::Split<'a, char>);

impl Fields<'_> {
    fn next<T: std::str::FromStr>(&mut self) -> Result<T, String> {
        let field = self.0.next().ok_or("a column is missing")?;
        field
            .parse()
            .map_err(|_| format!("`{field}` is not a number of its column"))
    }

    fn count(&mut self) -> Result<usize, String> {
        self.next()
    }

    fn estimate(&mut self) -> Result<Estimate, String> {
        Ok(Estimate {
            value: self.next()?,
            standard_error: self.next()?,
        })
    }

    fn fit(&mut self) -> Result<Fit, String> {
        Ok(Fit {
            mean: self.estimate()?,
            median: self.next()?,
            divergent: self.count()?,
            divergent_with_jump: self.count()?,
            failed: self.count()?,
        })
    }
}
