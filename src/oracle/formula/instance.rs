//! One value of a program with everything that it showed beside it: the data on which a formula is evaluated.
//!
//! A leaf of a formula takes its numbers from the program's own values. If a value is not shown, the right equations compute it from the
//! others.

use super::right::{Drawing, definition};
use super::tree::{Given, Leaf, Of, Tree, Value};
use super::value::{Matrix, Number, Term, With, by_rows};
use crate::filter::Update;
use crate::filter::extended::motion_jacobian;
use crate::imm::by_kind::seen;
use crate::imm::state_conversion::Reader;
use crate::imm::{Interaction, Problem, Quantity, Step};
use crate::model::Sensor;
use crate::number::{Field, Real};
use crate::oracle::filter_file::FilterFile;
use crate::oracle::judge::{Case, Place};
use crate::oracle::run::Record;
use crate::oracle::setup::Setup;
use crate::oracle::trace::Trace;
use nalgebra::{DMatrix, DVector, Dyn};

/// A run along a program's values: the record of each step with the program's values in it, and what the equations gave at each place.
pub(super) struct Along<'a> {
    pub(super) case: Case<'a>,
    pub(super) setup: Setup<Number>,
    /// Step 0 first; none where a step could not be evaluated.
    pub(super) steps: Vec<Record>,
    /// What the equations give of the program's own values.
    pub(super) own: Trace,
}

/// A value of a run.
#[derive(Clone, Copy)]
pub(super) struct Instance<'a> {
    pub(super) run: &'a Along<'a>,
    pub(super) place: Place,
    /// Whether the equations do not give it.
    pub(super) is_wrong: bool,
}

impl<'a> Instance<'a> {
    pub(super) fn problem(&self) -> &'a Problem<Number, Dyn, Dyn> {
        self.run.setup.problem_of(self.place.0)
    }

    /// The points that the filter of the mode draws.
    pub(super) fn drawing(&self) -> Drawing {
        let file = self.run.case.problem.filter_of(self.place.2);
        match (file, self.problem().filter(self.place.2).rules()) {
            (FilterFile::Unscented { .. }, _) => Drawing::Unscented,
            (_, [None, None]) => Drawing::None,
            _ => Drawing::Rule,
        }
    }

    /// The numbers of a leaf.
    pub(super) fn leaf(&self, leaf: Leaf, with: With) -> Option<Term> {
        match leaf.value {
            Value::Traced(quantity) => self.traced(quantity, leaf.of),
            Value::Given(given) => match leaf.of {
                Of::AtFirstStep => self.at(1, self.place.2).given(given),
                Of::Before => self.at(self.place.0 - 1, self.place.2).given(given),
                Of::First => self.at(self.place.0, 0).given(given),
                Of::Last => self.at(self.place.0, self.modes() - 1).given(given),
                _ => self.given(given),
            },
            Value::Defined(name) => match with.definition {
                Some((other, tree)) if other == name => tree.value(
                    self,
                    With {
                        definition: None,
                        ..with
                    },
                ),
                _ => definition(name, self.drawing())?.value(self, with),
            },
        }
    }

    /// The same quantity at another step and of another mode.
    fn at(&self, step: usize, mode: usize) -> Self {
        Instance {
            place: (step, self.place.1, mode),
            ..*self
        }
    }

    pub(super) fn modes(&self) -> usize {
        self.run.setup.problem.modes.len()
    }

    /// A value of the trace.
    fn traced(&self, quantity: Quantity, of: Of) -> Option<Term> {
        let (step, _, mode) = self.place;
        let last = self.modes() - 1;
        let list = |at: &dyn Fn(usize) -> Option<Matrix>| (0..=last).map(at).collect::<Option<_>>().map(Term::Each);
        let one = |step: Option<usize>, mode: usize| self.shown(step?, quantity, mode).map(Term::One);
        let before = step.checked_sub(1);
        let of_mode = quantity.is_of_mode();
        // No value explains itself.
        let is_another = |other: usize| of_mode && (quantity != self.place.1 || mode != other);
        match of {
            Of::Itself => one(Some(step), if of_mode { mode } else { 0 }),
            Of::Before => one(before, if of_mode { mode } else { 0 }),
            Of::First if is_another(0) => one(Some(step), 0),
            Of::Last if is_another(last) => one(Some(step), last),
            Of::Each if of_mode => list(&|mode| self.shown(step, quantity, mode)),
            Of::EachBefore if of_mode => list(&|mode| self.shown(before?, quantity, mode)),
            Of::Right => self
                .right(step, quantity, if of_mode { mode } else { 0 })
                .map(Term::One),
            Of::EachRight if of_mode => self.each_right(step, quantity),
            Of::EachRightBefore if of_mode && step > 1 => self.each_right(step - 1, quantity),
            _ => None,
        }
    }

    /// Whether the program shows all values of the trace that a formula is made of.
    pub(super) fn shows_inputs_of(&self, tree: &Tree) -> bool {
        let (step, _, mode) = self.place;
        let shown = self.run.case.shown;
        let is_shown = |step: usize, quantity: Quantity, mode: usize| {
            step == 0
                || shown
                    .get(step, quantity, if quantity.is_of_mode() { mode } else { 0 })
                    .is_some()
        };
        tree.leaves().into_iter().all(|leaf| match (leaf.value, leaf.of) {
            (Value::Traced(quantity), Of::Each) => (0..self.modes()).all(|mode| is_shown(step, quantity, mode)),
            (Value::Traced(quantity), Of::EachBefore) => {
                (0..self.modes()).all(|mode| is_shown(step - 1, quantity, mode))
            }
            (Value::Traced(quantity), Of::Before) => is_shown(step - 1, quantity, mode),
            (Value::Traced(quantity), _) => is_shown(step, quantity, mode),
            (Value::Defined(name), _) => {
                definition(name, self.drawing()).is_none_or(|tree| self.shows_inputs_of(&tree))
            }
            (Value::Given(_), _) => true,
        })
    }

    /// A value as the program shows it, or as the equations give it where it does not. At step 0 there are the initial estimates alone.
    fn shown(&self, step: usize, quantity: Quantity, mode: usize) -> Option<Matrix> {
        let is_initial = matches!(
            quantity,
            Quantity::UpdatedMean | Quantity::UpdatedCovariance | Quantity::ModeProbabilities
        );
        if step == 0 && !is_initial {
            return None;
        }
        let record = self.run.steps.get(step)?.as_ref()?;
        let values = record.values(quantity, mode)?;
        let m = record.measurement.as_ref().map_or(0, DVector::len);
        let (rows, columns) = quantity.shape(record.combined.mean.len(), m, self.modes());
        let input = values.iter().map(|value| Number::input(value.value()));
        (values.len() == rows * columns).then(|| DMatrix::from_row_iterator(rows, columns, input))
    }

    /// A value as the equations give it, where that is not what is shown.
    fn right(&self, step: usize, quantity: Quantity, mode: usize) -> Option<Matrix> {
        let shown = self.shown(step, quantity, mode)?;
        let own = self.run.own.get(step, quantity, mode)?;
        let input = own.iter().map(|value| Number::input(*value));
        let size = shown.iter().map(|entry| entry.value().abs()).fold(0.0, f64::max);
        let is_shown = by_rows(&shown)
            .iter()
            .zip(own)
            .all(|(shown, own)| (shown - own).abs() <= NEAR * size);
        (own.len() == shown.len() && !is_shown).then(|| DMatrix::from_row_iterator(shown.nrows(), shown.ncols(), input))
    }

    /// Of each mode what the equations give; nothing if all of it is shown.
    fn each_right(&self, step: usize, quantity: Quantity) -> Option<Term> {
        let right: Vec<Option<Matrix>> = (0..self.modes()).map(|mode| self.right(step, quantity, mode)).collect();
        if right.iter().all(Option::is_none) {
            return None;
        }
        let shown = |mode: usize| self.shown(step, quantity, mode);
        let all = right
            .into_iter()
            .enumerate()
            .map(|(mode, right)| right.or_else(|| shown(mode)));
        all.collect::<Option<_>>().map(Term::Each)
    }

    /// The record of the step.
    fn record(&self) -> Option<&'a Step<Number, Dyn, Dyn>> {
        self.run.steps.get(self.place.0)?.as_ref()
    }

    /// A value of the problem.
    fn given(&self, given: Given) -> Option<Term> {
        let (mode, problem) = (self.place.2, self.problem());
        let number = |value: f64| Some(DMatrix::from_element(1, 1, Number::exact(value)));
        let column = |values: &[Number]| Some(DMatrix::from_row_slice(values.len(), 1, values));
        let (n, m, r) = (problem.n().0, problem.m().0, self.modes());
        let initial = &self.run.setup.initial;
        let motion = &problem.modes.get(mode)?.motion;
        let matrix = match given {
            Given::MotionMatrix => motion.is_linear().then(|| motion.matrix().into_owned()),
            Given::MotionNoise => Some(problem.modes[mode].noise.clone()),
            Given::MeasurementMatrix => self.has_matrix().then(|| problem.h_of(mode).into_owned()),
            Given::MeasurementNoise => Some(problem.measurement_noise.clone()),
            Given::NoiseCrossCovariance => problem.filter(mode).noise_cross_covariance.clone(),
            Given::Measurement => column(self.record()?.measurement.as_ref()?.as_slice()),
            Given::LinearisationPoint => column(self.record()?.linearisation_points.get(mode)?.as_ref()?.as_slice()),
            Given::Truth => column(self.record()?.truth.as_ref()?.as_slice()),
            Given::Chain => Some(DMatrix::from_fn(r, r, |i, k| problem.chain[i][k])),
            Given::Column => Some(DMatrix::from_fn(r, 1, |i, _| problem.chain[i][mode])),
            Given::Row => Some(DMatrix::from_fn(r, 1, |i, _| problem.chain[mode][i])),
            Given::Identity => Some(DMatrix::identity(n, n)),
            Given::InitialMean => column(initial.modes[mode].mean.as_slice()),
            Given::InitialCovariance => Some(initial.modes[mode].covariance.clone()),
            Given::InitialProbabilities => column(&initial.mode_probabilities),
            Given::HalfLogOfTurns => {
                let turns = Real::ln(&(Number::pi() * Number::integer(2)));
                #[allow(clippy::cast_possible_wrap, reason = "m is at most some tens")]
                let half = turns * Number::ratio(m as i64, 2);
                Some(DMatrix::from_element(1, 1, half))
            }
            Given::Added => return self.added(),
            Given::One => number(1.0),
            #[allow(clippy::cast_precision_loss, reason = "n is at most some tens")]
            Given::Components => number(n as f64),
            Given::Gain | Given::InnovationCovariance => match &problem.filter(mode).update {
                Update::Given(fixed) if given == Given::Gain => Some(fixed.gain.clone()),
                Update::Given(fixed) => Some(fixed.innovation_covariance.clone()),
                _ => None,
            },
            Given::Alpha | Given::Beta | Given::Kappa => match self.run.case.problem.filter_of(mode) {
                FilterFile::Unscented { alpha, .. } if given == Given::Alpha => number(*alpha),
                FilterFile::Unscented { beta, .. } if given == Given::Beta => number(*beta),
                FilterFile::Unscented { kappa, .. } => number(*kappa),
                _ => None,
            },
            _ => return self.of_rule(given),
        };
        let input = |matrix: Matrix| matrix.map(|entry| Number::input(entry.value()));
        matrix.map(|matrix| Term::One(input(matrix)))
    }

    /// A value of the rule of the mode's filter.
    fn of_rule(&self, given: Given) -> Option<Term> {
        let rules = self.problem().filter(self.place.2).rules();
        let rule = rules.into_iter().flatten().next()?;
        let points = rule.points.len();
        let column = |values: &[Number]| Some(Term::One(DMatrix::from_row_slice(values.len(), 1, values)));
        let chosen = |of_first: i64, of_others: i64| {
            let entry = |i: usize, _| Number::integer(if i == 0 { of_first } else { of_others });
            Some(Term::One(DMatrix::from_fn(points, 1, entry)))
        };
        let point = |point: &DVector<Number>| DMatrix::from_column_slice(point.len(), 1, point.as_slice());
        let sign = |entry: Number| {
            Number::exact(if entry.value() == 0.0 {
                0.0
            } else {
                entry.value().signum()
            })
        };
        match given {
            Given::RulePoints => Some(Term::Each(rule.points.iter().map(point).collect())),
            Given::RuleAxes => Some(Term::Each(rule.points.iter().map(|of| point(of).map(sign)).collect())),
            Given::Weights => column(&rule.weights),
            Given::CovarianceWeights => column(&rule.covariance_weights),
            Given::FirstPoint => chosen(1, 0),
            Given::OtherPoints => chosen(0, 1),
            _ => None,
        }
    }

    /// Whether the measurement has a matrix.
    fn has_matrix(&self) -> bool {
        let problem = self.problem();
        let to_common = problem.state_conversion(self.place.2, Reader::Common);
        to_common.is_none_or(|conversion| conversion.map.is_linear())
            && (matches!(problem.sensor, Sensor::Linear(_)) || problem.filter(self.place.2).conversion().is_some())
    }

    /// Whether the measurement is a matrix, without an offset from the state of the mode to the common one.
    pub(super) fn measures_by_matrix(&self) -> bool {
        let to_common = self.problem().state_conversion(self.place.2, Reader::Common);
        self.has_matrix() && to_common.is_none_or(|conversion| conversion.map.offset().is_none())
    }

    /// Whether an entry of the measurement is an angle.
    pub(super) fn measures_angles(&self) -> bool {
        let problem = self.problem();
        (0..problem.m().0).any(|component| problem.sensor.is_angle(component))
    }

    /// The difference of a measurement from zero, angles wrapped.
    pub(super) fn wrapped(&self, a: &Matrix) -> Option<Matrix> {
        let problem = self.problem();
        let is_measured = a.shape() == (problem.m().0, 1) && problem.filter(self.place.2).conversion().is_none();
        let zero = DVector::zeros(problem.m().0);
        is_measured.then(|| {
            as_matrix(
                &problem
                    .sensor
                    .difference(&DVector::from_column_slice(a.as_slice()), &zero),
            )
        })
    }

    pub(super) fn moved(&self, a: &Matrix) -> Option<Matrix> {
        Some(as_matrix(
            &self.problem().modes.get(self.place.2)?.motion.of(&self.state(a)?),
        ))
    }

    pub(super) fn measured(&self, a: &Matrix) -> Option<Matrix> {
        Some(as_matrix(&seen(self.problem(), &self.state(a)?, self.place.2)))
    }

    pub(super) fn motion_slope(&self, a: &Matrix) -> Option<Matrix> {
        Some(motion_jacobian(
            &self.problem().modes.get(self.place.2)?.motion,
            &self.state(a)?,
        ))
    }

    pub(super) fn measurement_slope(&self, a: &Matrix) -> Option<Matrix> {
        Some(self.problem().slopes_of_measurement(self.place.2, &self.state(a)?))
    }

    /// Who reads the estimates of the modes in this value's equation.
    pub(super) fn reader(&self) -> Reader {
        if self.place.1.is_of_mode() {
            Reader::Mode(self.place.2)
        } else {
            Reader::Common
        }
    }

    pub(super) fn read(&self, a: &Matrix, mode: usize) -> Option<Matrix> {
        match self.problem().state_conversion(mode, self.reader()) {
            Some(conversion) => Some(as_matrix(&conversion.map.of(&self.state(a)?))),
            None => Some(a.clone()),
        }
    }

    pub(super) fn read_slope(&self, a: &Matrix, mode: usize) -> Option<Matrix> {
        let state = self.state(a)?;
        match self.problem().state_conversion(mode, self.reader()) {
            Some(conversion) => Some(motion_jacobian(&conversion.map, &state)),
            None => Some(DMatrix::identity(state.len(), state.len())),
        }
    }

    /// Of each mode what is added to its covariance where it is read.
    fn added(&self) -> Option<Term> {
        let (problem, n) = (self.problem(), self.problem().n().0);
        if !matches!(problem.interaction, Interaction::Converted(_)) {
            return None;
        }
        let of_mode = |mode| match problem.state_conversion(mode, self.reader()) {
            Some(conversion) => conversion.added.map(|entry| Number::input(entry.value())),
            None => DMatrix::zeros(n, n),
        };
        Some(Term::Each((0..self.modes()).map(of_mode).collect()))
    }

    fn state(&self, a: &Matrix) -> Option<DVector<Number>> {
        (a.shape() == (self.problem().n().0, 1)).then(|| DVector::from_column_slice(a.as_slice()))
    }
}

/// What is shown is what the equations give if it is within so much of its greatest number: then it is not worth two names.
const NEAR: f64 = 1e-9;

fn as_matrix(vector: &DVector<Number>) -> Matrix {
    DMatrix::from_column_slice(vector.len(), 1, vector.as_slice())
}
