//! Whole problems and whole runs for the tests of the cycle: constant velocity and two turns, n = 4, m = 2.

#![allow(dead_code, reason = "each test file uses its own part of this one")]

pub mod problems;
pub mod program;
pub mod runs;
pub mod svg;

use immaculate::filter::Filter;
use immaculate::filter::fixed_gain::FixedGain;
use immaculate::gaussian::Gaussian;
use immaculate::imm::{Equations, Failure, Imm, Initial, Interaction, InvalidProblem, Problem, Step};
use immaculate::model::motion::{Mode, Motion, constant_velocity, coordinated_turn, integrated_noise};
use immaculate::model::{Conversion, PolarComponent, Sensor};
use immaculate::number::Rational;
use immaculate::rule::unscented::{Parameters, unscented};
use immaculate::rule::{Rule, RuleName};
use nalgebra::{Matrix4, SMatrix, SVector, U2, U4, Vector2, Vector4, matrix, vector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// The unit roundoff of a double: no operation is off by more than this part of its result.
pub const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// 3° a second, the turn rate of both papers, in radians a second.
pub const TURN_RATE: f64 = std::f64::consts::PI / 60.0;

/// The rules that are not wrong, all of which a linear problem must not distinguish.
pub const RULES: [&str; 5] = ["cubature-3", "unscented", "cubature-5", "simplex-5", "gauss-hermite-3"];

/// A transition matrix that is neither symmetric nor doubly stochastic: one that is hides a transposition.
pub const CHAIN: [[f64; 3]; 3] = [[0.9, 0.06, 0.04], [0.15, 0.8, 0.05], [0.02, 0.08, 0.9]];

/// All that a run needs.
#[derive(Clone)]
pub struct Scene {
    /// What the filter is given.
    pub problem: Problem<f64, U4, U2>,
    /// The equations it computes.
    pub equations: Equations<f64, U4, U2>,
    /// Its estimate at step 0.
    pub initial: Initial<f64, U4>,
    /// What it measures, or misses, step by step.
    pub measurements: Vec<Option<Vector2<f64>>>,
}

impl Scene {
    /// The filter at step 0.
    pub fn filter(&self) -> Result<Imm<f64, U4, U2>, InvalidProblem> {
        Imm::with_equations(self.problem.clone(), self.equations, &self.initial)
    }

    /// The steps from 1 on, up to the failure if there is one.
    pub fn try_run(&self) -> Result<Vec<Step<f64, U4, U2>>, Failure> {
        let mut filter = self.filter().expect("the scene is a valid problem");
        let mut steps = Vec::new();
        for z in &self.measurements {
            steps.push(filter.step(z.as_ref())?.clone());
        }
        Ok(steps)
    }

    /// The steps from 1 on.
    pub fn run(&self) -> Vec<Step<f64, U4, U2>> {
        self.try_run().expect("every step can be computed")
    }
}

/// A scene with a linear measurement of both positions, and Kalman filters.
pub fn linear_scene() -> Scene {
    let h = matrix![1.0, 0.0, 0.0, 0.0; 0.0, 0.0, 1.0, 0.0];
    Scene {
        problem: problem(Sensor::Linear(h), [1600.0, 400.0]),
        equations: Equations::standard(),
        initial: initial(),
        measurements: measurements(|x, y, noise| vector![x + 40.0 * noise[0], y + 20.0 * noise[1]]),
    }
}

/// The linear scene for filters with fixed gains, one a mode, which are of no equilibrium, and unequal innovation covariances.
pub fn fixed_gain_scene() -> Scene {
    let mut scene = linear_scene();
    let given = |j: f64| FixedGain {
        gain: matrix![0.5 + 0.1 * j, 0.02; 0.2, -0.01 * j; 0.03, 0.7 - 0.1 * j; 0.01, 0.3],
        innovation_covariance: matrix![3000.0 + 500.0 * j, 60.0; 60.0, 900.0 - 100.0 * j],
    };
    scene.problem.filters = [0.0, 1.0, 2.0].map(given).map(Filter::given).to_vec();
    for estimate in &mut scene.initial.modes {
        estimate.covariance.fill(0.0);
    }
    scene
}

/// A scene in which range and bearing are measured from the origin, for filters with the named rule.
pub fn polar_scene(rule: &str) -> Scene {
    polar_scene_seen_from([0.0, 0.0], rule)
}

/// The same seen from a sensor elsewhere.
pub fn polar_scene_seen_from(location: [f64; 2], rule: &str) -> Scene {
    let mut problem = problem(range_bearing_from(location), [1600.0, 49e-6]);
    problem.filters = vec![Filter::points(rule_of(rule))];
    Scene {
        problem,
        equations: Equations::standard(),
        initial: initial(),
        measurements: measurements(|x, y, noise| {
            let (x, y) = (x - location[0], y - location[1]);
            vector![x.hypot(y) + 40.0 * noise[0], y.atan2(x) + 0.007 * noise[1]]
        }),
    }
}

/// A path that begins over the sensor, for filters with the points of a rule: a weight that is too negative there loses a covariance.
pub fn scene_over_the_sensor(rule: Rule<f64, U4>) -> Scene {
    let mut scene = polar_scene("unscented");
    scene.problem.filters = vec![Filter::points(rule)];
    for estimate in &mut scene.initial.modes {
        estimate.mean = vector![0.0, 10.0, 0.0, -5.0];
        estimate.covariance = Matrix4::from_diagonal(&vector![1e6, 1e2, 1e6, 1e2]);
    }
    for (k, z) in scene.measurements.iter_mut().enumerate() {
        let t = k as f64 + 1.0;
        *z = Some(vector![(10.0 * t).hypot(5.0 * t), (-5.0_f64).atan2(10.0)]);
    }
    scene
}

/// The unscented rule with κ = numerator/2.
pub fn unscented_of(numerator: i64) -> Rule<f64, U4> {
    let parameters = Parameters::of_kappa(Rational::new(numerator, 2));
    Rule::from_exact(&unscented(4, &parameters).expect("κ is above −n")).expect("its points have four components")
}

/// The same converted to positions.
pub fn converted_scene(conversion: Conversion, location: [f64; 2]) -> Scene {
    let mut scene = polar_scene_seen_from(location, "simplex-5");
    scene.problem.filters = vec![Filter::converted(conversion)];
    scene
}

/// The linear scene for cubature filters with the named rule.
pub fn linear_scene_with(rule: &str) -> Scene {
    let mut scene = linear_scene();
    scene.problem.filters = vec![Filter::points(rule_of(rule))];
    scene
}

/// Every filter on every measurement it can have, with a name for messages.
pub fn all_scenes() -> Vec<(String, Scene)> {
    let mut scenes = vec![("linear, kalman".to_owned(), linear_scene())];
    for rule in RULES {
        scenes.push((format!("linear, {rule}"), linear_scene_with(rule)));
        scenes.push((format!("polar, {rule}"), polar_scene(rule)));
    }
    scenes
}

/// A rule by name.
pub fn rule_of(name: &str) -> Rule<f64, U4> {
    let name: RuleName = name.parse().expect("a known rule");
    name.rule().expect("a rule of dimension four")
}

/// Range and bearing from a sensor.
pub fn range_bearing_from(location: [f64; 2]) -> Sensor<f64, U4, U2> {
    Sensor::Polar {
        components: vec![PolarComponent::Range, PolarComponent::Bearing],
        position: [0, 2],
        location,
    }
}

/// A mode under white acceleration noise of 1 m²/s³, with steps of a second.
pub fn mode(name: &str, transition: Matrix4<f64>) -> Mode<f64, U4> {
    Mode {
        name: name.to_owned(),
        motion: Motion::Linear(transition),
        noise: integrated_noise(&1.0, &1.0),
    }
}

/// The problem of constant velocity and two turns.
fn problem(sensor: Sensor<f64, U4, U2>, noise: [f64; 2]) -> Problem<f64, U4, U2> {
    Problem {
        modes: vec![
            mode("constant velocity", constant_velocity(&1.0)),
            mode("left turn", coordinated_turn(&TURN_RATE, &1.0)),
            mode("right turn", coordinated_turn(&-TURN_RATE, &1.0)),
        ],
        chain: CHAIN.map(|row| row.to_vec()).to_vec(),
        sensor,
        measurement_noise: SMatrix::from_diagonal(&SVector::from(noise)),
        filters: vec![Filter::kalman()],
        interaction: Interaction::Imm,
        angles: vec![],
    }
}

/// Three estimates that differ from each other, with correlated covariances, so that no equation sees a special case.
fn initial() -> Initial<f64, U4> {
    let covariance = matrix![
        1e4, 300.0, 800.0, 20.0;
        300.0, 100.0, -15.0, 5.0;
        800.0, -15.0, 9e3, -200.0;
        20.0, 5.0, -200.0, 120.0];
    let estimate = |offset: Vector4<f64>, scale: f64| Gaussian {
        mean: truth()[0] + offset,
        covariance: covariance * scale,
    };
    Initial {
        modes: vec![
            estimate(vector![30.0, -2.0, 50.0, 4.0], 1.0),
            estimate(vector![-40.0, 5.0, 10.0, -3.0], 1.5),
            estimate(vector![10.0, 1.0, -60.0, 2.0], 0.75),
        ],
        mode_probabilities: vec![0.625, 0.25, 0.125],
    }
}

/// The target: ten steps straight on, ten of a left turn, ten of a right turn. The state at step 0 is the first.
pub fn truth() -> Vec<Vector4<f64>> {
    let mut states = vec![vector![15000.0, -180.0, 1000.0, 200.0]];
    for k in 0..30 {
        let motion = match k / 10 {
            0 => constant_velocity(&1.0),
            1 => coordinated_turn(&TURN_RATE, &1.0),
            _ => coordinated_turn(&-TURN_RATE, &1.0),
        };
        states.push(motion * states[k]);
    }
    states
}

/// The measurements of the target by a function of its position and two draws of standard noise; step 7 and steps 15 to 17 have
/// no detection.
fn measurements(measure: impl Fn(f64, f64, Vector2<f64>) -> Vector2<f64>) -> Vec<Option<Vector2<f64>>> {
    let mut generator = ChaCha8Rng::seed_from_u64(20_160_805);
    let truth = truth();
    let mut measurements = Vec::new();
    for (k, state) in truth.iter().enumerate().skip(1) {
        let noise = vector![standard_noise(&mut generator), standard_noise(&mut generator)];
        let is_missed = k == 7 || (15..=17).contains(&k);
        measurements.push((!is_missed).then(|| measure(state[0], state[2], noise)));
    }
    measurements
}

/// The sum of twelve uniform numbers less six: mean zero, variance one, and near enough to a Gaussian for a law that holds for
/// every measurement.
fn standard_noise(generator: &mut ChaCha8Rng) -> f64 {
    let uniform = |bits: u32| f64::from(bits) / 4_294_967_296.0;
    (0..12).map(|_| uniform(generator.next_u32())).sum::<f64>() - 6.0
}

/// How far two estimates are apart, in standard deviations of the second: the greatest of |Δx̂ᵢ|/√Pᵢᵢ and |ΔPᵢⱼ|/√(PᵢᵢPⱼⱼ).
pub fn distance(a: &Gaussian<f64, U4>, b: &Gaussian<f64, U4>) -> f64 {
    let deviation = b.covariance.diagonal().map(f64::sqrt);
    let mut greatest = 0.0_f64;
    for i in 0..4 {
        greatest = worse(greatest, (a.mean[i] - b.mean[i]).abs() / deviation[i]);
        for j in 0..4 {
            let difference = (a.covariance[(i, j)] - b.covariance[(i, j)]).abs();
            greatest = worse(greatest, difference / (deviation[i] * deviation[j]));
        }
    }
    greatest
}

/// How far two runs are apart: the greatest distance of their estimates in standard deviations, or of their mode probabilities.
pub fn distance_of_runs(a: &[Step<f64, U4, U2>], b: &[Step<f64, U4, U2>]) -> f64 {
    assert_eq!(a.len(), b.len());
    let mut greatest = 0.0_f64;
    for (a, b) in a.iter().zip(b) {
        for (a, b) in estimates(a).iter().zip(estimates(b)) {
            greatest = worse(greatest, distance(a, b));
        }
        for (a, b) in a.mode_probabilities.iter().zip(&b.mode_probabilities) {
            greatest = worse(greatest, (a - b).abs());
        }
    }
    greatest
}

/// All estimates of a step, mode by mode, then the combined ones.
fn estimates(step: &Step<f64, U4, U2>) -> Vec<&Gaussian<f64, U4>> {
    let modes = step.mixed.iter().chain(&step.predicted).chain(&step.updated);
    modes.chain([&step.combined_prediction, &step.combined]).collect()
}

/// The greater of two distances, where a distance that is not a number is the greatest of all.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        return f64::INFINITY;
    }
    a.max(b)
}

/// What rounding can add up to in a run, in standard deviations.
///
/// A rounding of a coordinate x is at most 2⁻⁵³ |x|, that is 2⁻⁵³ |x|/σ of its standard deviation. Each value of a step is
/// computed in fewer than a thousand roundings (a sum over the 81 points of the greatest rule, the products that make a point, ten
/// equations in a row). A filter forgets its past, so the roundings of the steps add at most.
pub fn rounding_of(run: &[Step<f64, U4, U2>]) -> f64 {
    let mut digits_lost = 1.0_f64;
    for estimate in run.iter().flat_map(estimates) {
        for i in 0..4 {
            let deviations = estimate.mean[i].abs() / estimate.covariance[(i, i)].sqrt();
            digits_lost = worse(digits_lost, deviations);
        }
    }
    1000.0 * run.len() as f64 * digits_lost * ROUNDOFF
}

/// The bits of doubles. All that are not a number count as one.
pub fn bits<'a>(values: impl IntoIterator<Item = &'a f64>) -> Vec<u64> {
    let canonical = |value: &f64| if value.is_nan() { f64::NAN } else { *value };
    values.into_iter().map(|value| canonical(value).to_bits()).collect()
}

/// The bits of an estimate.
pub fn bits_of(estimate: &Gaussian<f64, U4>) -> Vec<u64> {
    let mut all = bits(&estimate.mean);
    all.extend(bits(&estimate.covariance));
    all
}
