//! Hard arithmetic: large positions, small and large units, nearly or exactly singular covariances.
//!
//! A right filter may lose digits here. The same scene also appears in other units.

use super::draft::{Draft, covariance, filter, map, rounded, rows, square};
use super::scene::{PLANE_TRACK, RADAR_TRACK, SENSOR, plane, radar};
use immaculate::model::motion::{constant_velocity, coordinated_turn};
use immaculate::oracle::problem::{MeasurementFile, ProblemFile, Rows};
use nalgebra::SMatrix;

/// The problems of this file.
pub fn all() -> Vec<ProblemFile> {
    [far(), units(), singular()].concat()
}

/// A matrix as rounded rows.
pub fn rounded_rows<const H: usize, const W: usize>(matrix: &SMatrix<f64, H, W>) -> Rows {
    let row = |row| (0..W).map(|column| rounded(matrix[(row, column)])).collect();
    (0..H).map(row).collect()
}

/// Where the scene is moved to: two Earth's radii, m.
const FAR: [f64; 2] = [6_378_000.0, -6_356_700.0];

/// The scene moved to [`FAR`], with motions that are the same everywhere.
fn moved(draft: Draft) -> Draft {
    draft.with(|problem| {
        let motions = [
            constant_velocity(&1.0),
            coordinated_turn(&0.3, &1.0),
            coordinated_turn(&-0.4, &1.0),
        ];
        for (mode, motion) in problem.modes.iter_mut().zip(&motions) {
            mode.transition = rounded_rows(motion);
        }
        for estimate in &mut problem.initial.modes {
            estimate.mean[0] += FAR[0];
            estimate.mean[2] += FAR[1];
        }
    })
}

fn far() -> Vec<ProblemFile> {
    let positions = rows([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
    let measured = [[141.0, -48.0], [130.0, -63.0], [152.0, -35.0]].map(|[x, y]| [x + FAR[0], y + FAR[1]]);
    vec![
        moved(plane()).linear(positions, covariance(&[11.0, 9.0], &[0.3])).sees(&measured).named(
            "far.linear",
            &["sequence", "far-from-origin", "spread", "full-correlation"],
            "Positions as large as the Earth's radius, deviations of metres: a spread or covariance computed as a difference of squares \
             has no digit left.",
        ),
        moved(radar("cubature-5"))
            .with(|problem| {
                if let MeasurementFile::RangeBearing { sensor, .. } = &mut problem.measurement {
                    *sensor = [SENSOR[0] + FAR[0], SENSOR[1] + FAR[1]];
                }
            })
            .sees(&RADAR_TRACK[..3])
            .named(
                "far.range-bearing",
                &["sequence", "far-from-origin", "spread", "components", "full-correlation"],
                "Target and sensor as far from the origin as the Earth's radius, and near to each other: the sensor's place must be \
                 subtracted before anything is squared.",
            ),
    ]
}

/// The scene in other units: every entry of the state and of the measurement times its factor.
pub(super) fn scaled(draft: Draft, state: [f64; 4], measured: f64) -> Draft {
    draft.with(|problem| {
        let product = |row: usize, column: usize, entry: f64| state[row] * state[column] * entry;
        for mode in &mut problem.modes {
            mode.transition = map(&mode.transition, |row, column, entry| {
                entry * (state[row] / state[column])
            });
            mode.noise = map(&mode.noise, product);
        }
        for estimate in &mut problem.initial.modes {
            let mean = estimate.mean.iter().zip(state);
            estimate.mean = mean.map(|(entry, factor)| rounded(entry * factor)).collect();
            estimate.covariance = estimate.covariance.as_ref().map(|rows| map(rows, product));
        }
        if let MeasurementFile::Linear { matrix } = &mut problem.measurement {
            *matrix = map(matrix, |_, column, entry| entry * (measured / state[column]));
        }
        problem.noise = map(&problem.noise, |_, _, entry| entry * (measured * measured));
        for z in problem.measurements.iter_mut().filter_map(|entry| entry.z.as_mut()) {
            for value in z.iter_mut().flatten() {
                *value = rounded(*value * measured);
            }
        }
    })
}

fn units() -> Vec<ProblemFile> {
    let scene = || plane().sees(&PLANE_TRACK[..3]);
    let named = |draft: Draft, position: &str, velocity: &str| {
        draft.with(|problem| problem.units = [position, velocity, position, velocity].map(str::to_owned).to_vec())
    };
    let flags = ["sequence", "units", "full-correlation"];
    vec![
        named(scaled(scene(), [1e9; 4], 1e9), "nm", "nm/s").named(
            "units.nanometres",
            &flags,
            "The first three steps of steps.kalman in nanometres: the same probabilities, and log-likelihoods that differ by -2 ln 1e9. An \
             absolute threshold on a determinant, a floor under likelihoods or a jitter on a covariance shows here or in units.gigametres.",
        ),
        named(scaled(scene(), [1e-9; 4], 1e-9), "Gm", "Gm/s").named(
            "units.gigametres",
            &flags,
            "The first three steps of steps.kalman in gigametres: covariances of 1e-16 are not singular. A jitter such as 1e-9 on a \
             diagonal is larger than all there is.",
        ),
        scaled(scene().filter(filter("simplex-5")), [1e6, 1e-6, 1e6, 1e-6], 1.0)
            .with(|problem| problem.units = ["um", "Mm/s", "um", "Mm/s"].map(str::to_owned).to_vec())
            .named(
                "units.mixed",
                &["sequence", "units", "as-kalman", "full-correlation"],
                "The first three steps of steps.kalman with positions in micrometres, velocities in megametres a second and measurements in \
                 metres, by simplex filters: covariances of condition 1e24 that are perfectly well determined.",
            ),
    ]
}

/// A covariance of rank two that is exact in binary.
fn rank_two() -> Rows {
    let g = [[0.5, 0.25], [1.25, -0.5], [-0.25, 0.75], [0.5, 1.5]];
    square(4, |row, column| {
        2.0 * g[row][0] * g[column][0] + 3.0 * g[row][1] * g[column][1]
    })
}

fn singular() -> Vec<ProblemFile> {
    vec![
        plane()
            .linear(
                rows([[1.0, 0.1, -0.2, 0.05], [1.000_01, 0.1, -0.2, 0.05]]),
                covariance(&[11.0, 11.0], &[0.999_999_999_9]),
            )
            .sees(&[[160.0, 160.0015]])
            .named(
                "singular.innovation",
                &["single-step", "nearly-singular", "full-correlation"],
                "Two measured numbers that are nearly the same: the condition of S is above 1e10. An explicit inverse or a determinant by \
                 cofactors loses digits here, and a right filter loses some, too.",
            ),
        plane()
            .linear(rows([[1.0, 0.1, -0.2, 0.05], [0.15, -0.08, 1.1, 0.12]]), covariance(&[0.002, 0.001], &[0.3]))
            .sees(&[[149.0, -47.0], [157.5, -36.2]])
            .named(
                "singular.updated",
                &["sequence", "nearly-singular", "full-correlation"],
                "A measurement ten thousand times more accurate than the prediction: P - W S W' is nearly singular, and so is what the next \
                 step starts from. A form that does not keep covariances positive shows here.",
            ),
        plane()
            .with(|problem| problem.modes.iter_mut().for_each(|mode| mode.noise = rank_two()))
            .sees(&PLANE_TRACK[..3])
            .named(
                "singular.process-noise",
                &["sequence", "singular-noise", "full-correlation"],
                "Q of rank two, as of two accelerations that drive four entries: semidefinite is all that Q must be, and a filter that takes \
                 its Cholesky factor fails.",
            ),
    ]
}
