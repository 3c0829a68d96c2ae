//! The path of the target: the true states of scenarios 1 and 2.
//!
//! Both paths are given coordinate by coordinate, with the points that the paper leaves open. The truth has no noise and is the same in
//! every run.

use crate::model::acceleration::constant_acceleration;
use crate::model::motion::coordinated_turn;
use nalgebra::{Vector2, Vector3, Vector4};

/// The two coordinates' states [p, v, a], m, m/s and m/s².
pub type PlaneState = [Vector3<f64>; 2];

/// What the target does in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Constant acceleration.
    Acceleration,
    /// Constant velocity.
    Straight,
    /// A coordinated turn, whose acceleration is at right angles to its velocity.
    Turn,
}

/// A path: the state at step 0, those of steps 1, 2, …, and what led to them.
#[derive(Debug, Clone, PartialEq)]
pub struct TruePath {
    /// The state at step 0.
    pub start: PlaneState,
    /// The states at steps 1, 2, …
    pub places: Vec<PlaneState>,
    /// What the target did in steps 1, 2, …
    pub motions: Vec<Regime>,
}

/// What scenario 1 leaves open about its straight line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// At rest at step 0; past the radar with a growing speed.
    FromRest,
    /// Towards the closest point, at rest there, and back.
    TurningPoint,
    /// Braking towards the closest point, at rest there, and on with a growing speed.
    Reversed,
}

/// What scenario 2 leaves open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Manoeuvres {
    /// The position at step 0, m.
    pub start: [f64; 2],
    /// The direction of the first motion, rad from x towards y.
    pub heading: f64,
    /// The speed at step 0, m/s.
    pub speed: f64,
    /// The acceleration, m/s².
    pub acceleration: f64,
    /// The turn rate, rad/s, positive to the left.
    pub turn_rate: f64,
}

/// Scenario 1: x = ±½ a (τ − τ₀)² + x₀ and y = the distance of the closest approach, which step `closest` reaches.
pub fn line(line: Line, acceleration: f64, distance: f64, closest: usize, points: usize, interval: f64) -> TruePath {
    let closest_time = closest as f64 * interval;
    let run_up = acceleration * closest_time * closest_time / 2.0;
    let at = |k: usize| {
        let time = k as f64 * interval;
        let x = match line {
            Line::FromRest => Vector3::new(
                acceleration * time * time / 2.0 - run_up,
                acceleration * time,
                acceleration,
            ),
            // The step to the closest point still brakes.
            Line::Reversed if k <= closest => -falling(acceleration, time - closest_time),
            Line::TurningPoint | Line::Reversed => falling(acceleration, time - closest_time),
        };
        [x, Vector3::new(distance, 0.0, 0.0)]
    };
    TruePath {
        start: at(0),
        places: (1..=points).map(at).collect(),
        motions: vec![Regime::Acceleration; points],
    }
}

/// Constant acceleration from rest at the origin at time 0, before and after it.
fn falling(acceleration: f64, time: f64) -> Vector3<f64> {
    Vector3::new(acceleration * time * time / 2.0, acceleration * time, acceleration)
}

/// Scenario 2: acceleration along the heading, straight on, a turn, straight on.
pub fn manoeuvres(open: &Manoeuvres, phases: [usize; 4], interval: f64) -> TruePath {
    let direction = direction(open.heading);
    let mut place: PlaneState = [0, 1].map(|c| {
        Vector3::new(
            open.start[c],
            open.speed * direction[c],
            open.acceleration * direction[c],
        )
    });
    let start = place;
    let kinds = [Regime::Acceleration, Regime::Straight, Regime::Turn, Regime::Straight];
    let phases = kinds.into_iter().zip(phases);
    let motions: Vec<Regime> = phases.flat_map(|(motion, steps)| vec![motion; steps]).collect();
    let mut places = Vec::with_capacity(motions.len());
    for motion in &motions {
        place = match motion {
            Regime::Acceleration => place.map(|state| constant_acceleration(&interval) * state),
            Regime::Straight => place.map(|state| straight(state, interval)),
            Regime::Turn => turn(place, open.turn_rate, interval),
        };
        places.push(place);
    }
    TruePath { start, places, motions }
}

/// The unit vector of a heading.
pub(super) fn direction(heading: f64) -> Vector2<f64> {
    Vector2::new(libm::cos(heading), libm::sin(heading))
}

/// One step of constant velocity; the acceleration is over.
fn straight(state: Vector3<f64>, interval: f64) -> Vector3<f64> {
    Vector3::new(state[0] + interval * state[1], state[1], 0.0)
}

/// One step of a turn; the acceleration at its end is ω times the velocity, a right angle to the left of it.
fn turn([x, y]: PlaneState, turn_rate: f64, interval: f64) -> PlaneState {
    let turned = coordinated_turn(&turn_rate, &interval) * Vector4::new(x[0], x[1], y[0], y[1]);
    [
        Vector3::new(turned[0], turned[1], -turn_rate * turned[3]),
        Vector3::new(turned[2], turned[3], turn_rate * turned[1]),
    ]
}

/// The position of both coordinates.
pub fn position_of(place: &PlaneState) -> Vector2<f64> {
    Vector2::new(place[0][0], place[1][0])
}
