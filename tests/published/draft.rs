//! A short notation for problems.
//!
//! The numbers of the published problems are short decimals, covariances from standard deviations and correlations, and, if a formula
//! gives a number, its first twelve significant digits. The rounded number *is* the input.

use immaculate::oracle::models::ModelParameters;
use immaculate::oracle::problem::{
    Conventions, EstimateFile, FORMAT, FilterFile, InitialFile, MeasurementAt, MeasurementFile, ModeFile, ProblemFile,
    Rows,
};

/// Significant digits of a number that a formula gives.
const DIGITS: usize = 12;

/// A number with [`DIGITS`] significant digits.
pub fn rounded(value: f64) -> f64 {
    rounded_to(value, DIGITS)
}

/// The double nearest to the decimal with a number of significant digits; a zero has no sign.
pub fn rounded_to(value: f64, digits: usize) -> f64 {
    let places = digits - 1;
    format!("{value:.places$e}").parse().unwrap_or(value) + 0.0
}

/// A matrix from its rows.
pub fn rows<const H: usize, const W: usize>(entries: [[f64; W]; H]) -> Rows {
    entries.map(|row| row.to_vec()).to_vec()
}

/// The unit matrix.
pub fn identity(n: usize) -> Rows {
    square(n, |row, column| if row == column { 1.0 } else { 0.0 })
}

/// A square matrix from a formula.
pub fn square(n: usize, entry: impl Fn(usize, usize) -> f64) -> Rows {
    let row = |row| (0..n).map(|column| entry(row, column)).collect();
    (0..n).map(row).collect()
}

/// A matrix, every entry changed by a formula of row, column and entry, and rounded.
pub fn map(matrix: &Rows, change: impl Fn(usize, usize, f64) -> f64) -> Rows {
    let changed = |(row, entries): (usize, &Vec<f64>)| {
        let entries = entries.iter().enumerate();
        entries
            .map(|(column, &entry)| rounded(change(row, column, entry)))
            .collect()
    };
    matrix.iter().enumerate().map(changed).collect()
}

/// A covariance from standard deviations and correlations: ρ₂₁, ρ₃₁, ρ₃₂, ρ₄₁, … below the diagonal, row by row.
pub fn covariance(deviations: &[f64], correlations: &[f64]) -> Rows {
    let entry = |row: usize, column: usize| {
        let (low, high) = (row.min(column), row.max(column));
        let correlation = if low == high {
            1.0
        } else {
            correlations[high * (high - 1) / 2 + low]
        };
        rounded(deviations[low] * deviations[high] * correlation)
    };
    square(deviations.len(), entry)
}

/// An estimate.
pub fn estimate(mean: &[f64], covariance: Rows) -> EstimateFile {
    EstimateFile {
        mean: mean.to_vec(),
        covariance: Some(covariance),
    }
}

/// A mode.
pub fn mode(name: &str, transition: Rows, noise: Rows) -> ModeFile {
    ModeFile {
        name: name.to_owned(),
        transition,
        noise,
        ..ModeFile::default()
    }
}

/// The filter of a name: `kalman`, or that of a rule.
pub fn filter(name: &str) -> FilterFile {
    match name {
        "kalman" => FilterFile::Kalman {},
        rule => FilterFile::Cubature { rule: rule.to_owned() },
    }
}

/// An unscented filter.
pub fn unscented(alpha: f64, beta: f64, kappa: f64) -> FilterFile {
    FilterFile::Unscented { alpha, beta, kappa }
}

/// Owned words.
pub fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|&word| word.to_owned()).collect()
}

/// A problem that is being written: what it lacks is its name and its purpose.
#[derive(Clone)]
pub(super) struct Draft(pub(super) ProblemFile);

impl Draft {
    /// A problem of Kalman filters with a linear measurement, whose modes all go on as they are, without measurements.
    pub fn new(state: &[&str], units: &[&str], parts: Vec<(ModeFile, EstimateFile)>) -> Self {
        let r = parts.len();
        let (modes, estimates) = parts.into_iter().unzip();
        Self(ProblemFile {
            format: FORMAT.to_owned(),
            id: String::new(),
            about: String::new(),
            flags: Vec::new(),
            state: state.iter().map(|&name| name.into()).collect(),
            units: words(units),
            parameters: ModelParameters::default(),
            definitions: Vec::new(),
            modes,
            conversions: Vec::new(),
            measurement: MeasurementFile::Linear { matrix: Vec::new() },
            noise: Vec::new(),
            sensors: Vec::new(),
            filter: FilterFile::Kalman {},
            interaction: None,
            transition: identity(r),
            rates: None,
            sojourn_times: None,
            jumps: None,
            initial: InitialFile {
                mode_probabilities: vec![0.0; r],
                modes: estimates,
            },
            conventions: Conventions::default(),
            measurements: Vec::new(),
            declared: Vec::new(),
            lacks_consistency: false,
        })
    }

    /// The measurement z = H x + v and the covariance of v.
    pub fn linear(mut self, matrix: Rows, noise: Rows) -> Self {
        self.0.measurement = MeasurementFile::Linear { matrix };
        self.0.noise = noise;
        self
    }

    /// A sensor that measures the named components, and the covariance of its noise.
    pub fn polar(mut self, components: &[&str], position: [usize; 2], sensor: [f64; 2], noise: Rows) -> Self {
        self.0.measurement = MeasurementFile::RangeBearing {
            components: words(components),
            position,
            sensor,
        };
        self.0.noise = noise;
        self
    }

    /// The filter.
    pub fn filter(mut self, filter: FilterFile) -> Self {
        self.0.filter = filter;
        self
    }

    /// The modes of these places only, each as probable as before in relation to the others, on another chain.
    pub fn keep(mut self, places: &[usize]) -> Self {
        let problem = &mut self.0;
        problem.modes = places.iter().map(|&j| problem.modes[j].clone()).collect();
        problem.initial.modes = places.iter().map(|&j| problem.initial.modes[j].clone()).collect();
        if let FilterFile::FixedGain { modes, .. } = &mut problem.filter {
            *modes = places.iter().map(|&j| modes[j].clone()).collect();
        }
        match places.len() {
            1 => self.chain(rows([[1.0]]), &[1.0]),
            2 => self.chain(rows([[0.9, 0.1], [0.25, 0.75]]), &[0.6, 0.4]),
            _ => self,
        }
    }

    /// The transition matrix, and the probabilities at step 0.
    pub fn chain(mut self, transition: Rows, probabilities: &[f64]) -> Self {
        self.0.transition = transition;
        self.0.initial.mode_probabilities = probabilities.to_vec();
        self
    }

    /// One measurement a step.
    pub fn sees<const M: usize>(self, measurements: &[[f64; M]]) -> Self {
        let all: Vec<Option<[f64; M]>> = measurements.iter().copied().map(Some).collect();
        self.sees_or_misses(&all)
    }

    /// One measurement a step, or none.
    pub fn sees_or_misses<const M: usize>(mut self, measurements: &[Option<[f64; M]>]) -> Self {
        let entry = |(place, z): (usize, &Option<[f64; M]>)| MeasurementAt {
            step: place + 1,
            z: z.map(|z| seen(&z)),
            ..MeasurementAt::default()
        };
        self.0.measurements = measurements.iter().enumerate().map(entry).collect();
        self
    }

    /// A number of steps without a detection.
    pub fn misses(self, steps: usize) -> Self {
        self.sees_or_misses::<1>(&vec![None; steps])
    }

    /// These steps, counted from 1, become missed detections.
    pub fn without(mut self, steps: &[usize]) -> Self {
        for entry in &mut self.0.measurements {
            if steps.contains(&entry.step) {
                entry.z = None;
            }
        }
        self
    }

    /// Every mode stands still: F is the unit matrix, and Q a ten-thousandth of what it was.
    pub fn still(mut self) -> Self {
        let n = self.0.state.len();
        for mode in &mut self.0.modes {
            mode.transition = identity(n);
            mode.noise = map(&mode.noise, |_, _, entry| entry * 1e-4);
        }
        self
    }

    /// Any other change.
    pub fn with(mut self, change: impl FnOnce(&mut ProblemFile)) -> Self {
        change(&mut self.0);
        self
    }

    /// The problem, with its name, its flags and its purpose.
    pub fn named(self, id: &str, flags: &[&str], about: &str) -> ProblemFile {
        ProblemFile {
            id: id.to_owned(),
            about: about.to_owned(),
            flags: words(flags),
            ..self.0
        }
    }
}

/// A measurement of which nothing is missing.
pub fn seen(z: &[f64]) -> Vec<Option<f64>> {
    z.iter().copied().map(Some).collect()
}
