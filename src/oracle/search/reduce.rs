//! What can be removed from a problem: steps, modes, components, and every special feature.
//!
//! These are the larger steps of shrinking. Each proposes problems with one thing less; asking shows whether they are valid and still have
//! the fault.

use super::draw::{leading_identity, rounded};
use crate::model::space::ComponentKind;
use crate::oracle::models::NoiseFile;
use crate::oracle::problem::{FORMAT, FORMAT_2, FilterFile, MeasurementFile, ProblemFile, Rows};

/// The problem with a change.
pub(super) fn with(problem: &ProblemFile, change: impl FnOnce(&mut ProblemFile)) -> ProblemFile {
    let mut changed = problem.clone();
    change(&mut changed);
    changed
}

/// Removes a number of steps in a row: as many as possible first, the last ones first.
pub(super) fn steps(problem: &ProblemFile) -> Vec<ProblemFile> {
    let all = problem.measurements.len();
    let mut fewer = Vec::new();
    let mut length = all.saturating_sub(1);
    while length > 0 {
        for start in (0..=all - length).rev() {
            fewer.push(with(problem, |problem| {
                problem.measurements.drain(start..start + length);
                for (index, entry) in problem.measurements.iter_mut().enumerate() {
                    entry.step = index + 1;
                }
            }));
        }
        length /= 2;
    }
    fewer
}

/// Without one of the modes.
pub(super) fn modes(problem: &ProblemFile) -> Vec<ProblemFile> {
    if problem.modes.len() == 1 {
        return Vec::new();
    }
    let without = |j: usize| {
        with(problem, |problem| {
            let name = Some(problem.modes.remove(j).name);
            let is_of = |end: Option<&String>| end == name.as_ref();
            problem
                .conversions
                .retain(|one| !is_of(Some(&one.from)) && !is_of(one.to.as_ref()));
            problem.initial.modes.remove(j);
            remove_probability(&mut problem.initial.mode_probabilities, j);
            if !problem.transition.is_empty() {
                remove_from_chain(&mut problem.transition, j);
            }
            if let Some(rates) = &mut problem.rates {
                remove_from_rates(rates, j);
            }
            problem.sojourn_times.iter_mut().for_each(|times| {
                times.remove(j);
            });
            problem.jumps.iter_mut().for_each(|jumps| remove_from_chain(jumps, j));
            if let FilterFile::FixedGain { modes, .. } = &mut problem.filter {
                modes.remove(j);
            }
            for entry in &mut problem.measurements {
                for list in [&mut entry.transitions, &mut entry.noises].into_iter().flatten() {
                    list.remove(j);
                }
                entry
                    .transition
                    .iter_mut()
                    .for_each(|chain| remove_from_chain(chain, j));
            }
        })
    };
    (0..problem.modes.len()).map(without).collect()
}

fn remove_from_chain(chain: &mut Rows, j: usize) {
    chain.remove(j);
    for row in chain {
        remove_probability(row, j);
    }
}

/// Removes a mode; the others are left less often by the rate at which they were left for it.
fn remove_from_rates(rates: &mut Rows, j: usize) {
    remove_both(rates, j);
    for (i, row) in rates.iter_mut().enumerate() {
        row[i] = 0.0;
        row[i] = -row.iter().sum::<f64>();
    }
}

/// Removes a probability; the others grow in proportion, to two decimals.
fn remove_probability(row: &mut Vec<f64>, j: usize) {
    row.remove(j);
    let sum: f64 = row.iter().sum();
    for entry in row.iter_mut() {
        *entry = if sum > 0.0 {
            (100.0 * *entry / sum).round() / 100.0
        } else {
            0.0
        };
    }
    let mut greatest = 0;
    for index in 1..row.len() {
        if row[index] > row[greatest] {
            greatest = index;
        }
    }
    let others: f64 = row.iter().sum::<f64>() - row[greatest];
    row[greatest] = rounded(1.0 - others, 6);
}

/// Removes a row and a column.
fn remove_both<T>(rows: &mut Vec<Vec<T>>, index: usize) {
    rows.remove(index);
    remove_column(rows, index);
}

fn remove_column<T>(rows: &mut [Vec<T>], index: usize) {
    for row in rows {
        row.remove(index);
    }
}

/// Without one of the components of the state. Where a formula or a named model needs it, the problem is refused.
pub(super) fn components(problem: &ProblemFile) -> Vec<ProblemFile> {
    let n = problem.state.len();
    if n == 1 {
        return Vec::new();
    }
    (0..n)
        .rev()
        .map(|index| with(problem, |problem| remove_component(problem, index)))
        .collect()
}

fn remove_component(problem: &mut ProblemFile, index: usize) {
    problem.state.remove(index);
    if index < problem.units.len() {
        problem.units.remove(index);
    }
    for mode in &mut problem.modes {
        for rows in [&mut mode.transition, &mut mode.noise] {
            if !rows.is_empty() {
                remove_both(rows, index);
            }
        }
        if let Some(rows) = &mut mode.models.noise_cross_covariance {
            rows.remove(index);
        }
        if let Some(formulas) = &mut mode.models.formulas {
            formulas.remove(index);
        }
        if let Some(NoiseFile::Formulas(rows)) = &mut mode.models.noise {
            remove_both(rows, index);
        }
    }
    for estimate in &mut problem.initial.modes {
        estimate.mean.remove(index);
        estimate.covariance.iter_mut().for_each(|rows| remove_both(rows, index));
    }
    if let FilterFile::FixedGain { modes, .. } = &mut problem.filter {
        for mode in modes {
            mode.gain.remove(index);
        }
    }
    let of_sensors = problem.sensors.iter_mut().map(|sensor| &mut sensor.measurement);
    for measurement in std::iter::once(&mut problem.measurement).chain(of_sensors) {
        match measurement {
            MeasurementFile::Linear { matrix } => remove_column(matrix, index),
            MeasurementFile::RangeBearing { position, .. } => {
                // One of a position's own leads to a problem that is refused.
                position
                    .iter_mut()
                    .filter(|place| **place > index)
                    .for_each(|place| *place -= 1);
            }
            MeasurementFile::Formulas { .. } | MeasurementFile::Model { .. } => {}
        }
    }
    for entry in &mut problem.measurements {
        for list in [&mut entry.transitions, &mut entry.noises].into_iter().flatten() {
            for rows in list {
                remove_both(rows, index);
            }
        }
        entry.matrix.iter_mut().for_each(|rows| remove_column(rows, index));
        if let Some(truth) = &mut entry.truth {
            truth.remove(index);
        }
    }
}

/// Without one of the numbers that one of the sensors measures.
pub(super) fn measured(problem: &ProblemFile) -> Vec<ProblemFile> {
    let counts: Vec<usize> = problem.sensors_at().iter().map(|sensor| sensor.noise.len()).collect();
    let mut fewer = Vec::new();
    for (sensor, m) in counts.into_iter().enumerate().filter(|(_, m)| *m > 1) {
        fewer.extend(
            (0..m)
                .rev()
                .map(|row| with(problem, |problem| remove_measured(problem, sensor, row))),
        );
    }
    fewer
}

fn remove_measured(problem: &mut ProblemFile, sensor: usize, row: usize) {
    let seen: Vec<bool> = problem
        .measurements
        .iter()
        .map(|entry| problem.sensor_of(entry) == Some(sensor))
        .collect();
    let (measurement, noise) = if sensor == 0 {
        (&mut problem.measurement, &mut problem.noise)
    } else {
        let sensor = &mut problem.sensors[sensor - 1];
        (&mut sensor.measurement, &mut sensor.noise)
    };
    remove_both(noise, row);
    match measurement {
        MeasurementFile::Linear { matrix } => drop(matrix.remove(row)),
        MeasurementFile::RangeBearing { components, .. } => drop(components.remove(row)),
        MeasurementFile::Formulas { z, h } => {
            z.remove(row);
            h.remove(row);
        }
        // A named model measures what it measures, and the problem is refused.
        MeasurementFile::Model { .. } => {}
    }
    for mode in problem.modes.iter_mut().filter(|_| sensor == 0) {
        let of_noises = mode.models.noise_cross_covariance.iter_mut();
        of_noises.for_each(|rows| remove_column(rows, row));
    }
    if let FilterFile::FixedGain { modes, .. } = &mut problem.filter {
        for mode in modes {
            remove_column(&mut mode.gain, row);
            remove_both(&mut mode.innovation_covariance, row);
        }
    }
    for (entry, _) in problem
        .measurements
        .iter_mut()
        .zip(seen)
        .filter(|(_, is_seen)| *is_seen)
    {
        if let Some(z) = &mut entry.z {
            z.remove(row);
        }
        entry.matrix.iter_mut().for_each(|rows| drop(rows.remove(row)));
        entry.noise.iter_mut().for_each(|rows| remove_both(rows, row));
        if entry.entries().next().is_none() {
            entry.z = None;
        }
    }
}

/// Without one thing that is special.
pub(super) fn extras(problem: &ProblemFile) -> Vec<ProblemFile> {
    let n = problem.state.len();
    let mut plainer = Vec::new();
    for index in 0..problem.sensors.len() {
        plainer.push(with(problem, |problem| remove_sensor(problem, index)));
        plainer.push(with(problem, |problem| put_first(problem, index)));
    }
    for step in 0..problem.measurements.len() {
        plainer.extend(of_step(problem, step));
    }
    for j in 0..problem.modes.len() {
        plainer.extend(of_mode(problem, j));
    }
    if !matches!(problem.filter, FilterFile::Kalman {}) {
        plainer.push(with(problem, |problem| problem.filter = FilterFile::Kalman {}));
    }
    if !matches!(problem.measurement, MeasurementFile::Linear { .. }) {
        let matrix = leading_identity(problem.noise.len(), n);
        plainer.push(with(problem, |problem| {
            problem.measurement = MeasurementFile::Linear { matrix }
        }));
    }
    for index in 0..n {
        if problem.state[index].kind == ComponentKind::Angle {
            plainer.push(with(problem, |problem| {
                problem.state[index].kind = ComponentKind::Number;
                problem.conventions.state_angle_mean = None;
            }));
        }
    }
    for index in 0..problem.parameters.0.len() {
        plainer.push(with(problem, |problem| drop(problem.parameters.0.remove(index))));
    }
    for index in 0..problem.definitions.len() {
        plainer.push(with(problem, |problem| drop(problem.definitions.remove(index))));
    }
    if problem.interaction.is_some() {
        plainer.push(with(problem, |problem| problem.interaction = None));
    }
    if problem.format == FORMAT_2 {
        plainer.push(with(problem, |problem| {
            FORMAT.clone_into(&mut problem.format);
            problem.units = vec!["1".to_owned(); n];
            problem.state.iter_mut().for_each(|component| component.unit = None);
        }));
    }
    plainer
}

/// The steps of a sensor that is no more are those of the first one, which sees zeros there.
fn remove_sensor(problem: &mut ProblemFile, index: usize) {
    let name = Some(problem.sensors.remove(index).name);
    for entry in problem.measurements.iter_mut().filter(|entry| entry.sensor == name) {
        entry.sensor = None;
        (entry.matrix, entry.noise) = (None, None);
        if entry.z.is_some() {
            entry.z = Some(vec![Some(0.0); problem.noise.len()]);
        }
    }
}

/// A sensor in place of the first one; a step that the first one sees then has the wrong number of entries, or another meaning.
fn put_first(problem: &mut ProblemFile, index: usize) {
    let sensor = problem.sensors.remove(index);
    (problem.measurement, problem.noise) = (sensor.measurement, sensor.noise);
    for entry in &mut problem.measurements {
        entry.sensor = entry.sensor.take().filter(|name| *name != sensor.name);
    }
}

/// A step without one thing that it has for itself; a missed detection becomes zeros.
fn of_step(problem: &ProblemFile, step: usize) -> Vec<ProblemFile> {
    let m = problem.dimensions().m[step];
    let changes: [fn(&mut crate::oracle::steps::MeasurementAt); 7] = [
        |entry| entry.interval = None,
        |entry| entry.transitions = None,
        |entry| entry.noises = None,
        |entry| entry.matrix = None,
        |entry| entry.noise = None,
        |entry| entry.transition = None,
        |entry| entry.truth = None,
    ];
    let mut plainer: Vec<ProblemFile> = changes
        .iter()
        .map(|change| with(problem, |problem| change(&mut problem.measurements[step])))
        .collect();
    match &problem.measurements[step].z {
        None => plainer.push(with(problem, |problem| {
            problem.measurements[step].z = Some(vec![Some(0.0); m]);
        })),
        Some(z) => plainer.push(with(problem, |problem| {
            problem.measurements[step].z = Some(z.iter().map(|value| value.or(Some(0.0))).collect());
        })),
    }
    plainer
}

/// A mode without one of its functions, or without a filter of its own.
fn of_mode(problem: &ProblemFile, j: usize) -> Vec<ProblemFile> {
    let n = problem.state.len();
    let models = &problem.modes[j].models;
    let mut plainer = Vec::new();
    if models.noise_cross_covariance.is_some() {
        plainer.push(with(problem, |problem| {
            problem.modes[j].models.noise_cross_covariance = None;
        }));
    }
    if models.formulas.is_some() || models.motion.is_some() {
        plainer.push(with(problem, |problem| {
            let mode = &mut problem.modes[j];
            (mode.models.formulas, mode.models.motion) = (None, None);
            mode.transition = leading_identity(n, n);
        }));
    }
    for (index, formula) in models.formulas.iter().flatten().enumerate() {
        let name = &problem.state[index].name;
        if formula != name {
            plainer.push(with(problem, |problem| {
                let formulas = problem.modes[j].models.formulas.iter_mut().flatten();
                formulas
                    .skip(index)
                    .take(1)
                    .for_each(|formula| formula.clone_from(name));
            }));
        }
    }
    if models.noise.is_some() {
        plainer.push(with(problem, |problem| {
            problem.modes[j].models.noise = None;
            problem.modes[j].noise = leading_identity(n, n);
        }));
    }
    if matches!(&models.noise, Some(NoiseFile::Formulas(_)))
        || !models.definitions.is_empty()
        || !models.parameters.is_empty()
    {
        plainer.push(with(problem, |problem| {
            problem.modes[j].models.definitions.clear();
            problem.modes[j].models.parameters.0.clear();
        }));
    }
    if models.filter.is_some() {
        plainer.push(with(problem, |problem| problem.modes[j].models.filter = None));
    }
    plainer
}
