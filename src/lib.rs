//! Immaculate: the executable specification of the interacting multiple model filter.
//!
//! A target sometimes flies straight and sometimes turns. Several filters track it at once, one for each *mode* of motion, and mix their
//! estimates before every step. Four papers use fixed-gain, Kalman, cubature, unscented and converted-measurement filters inside it. Each
//! of their equations is one plain function here, labelled with its printed number and generic over the number system. This is the book
//! of these equations, arranged by code. Each entry gives the formula in the papers' letters and in the names of the code, the reason why
//! it holds, an example by hand, the misprints, and the tests that are its evidence. The papers are `zhu2016`, `liu2017`, `derbez2000`
//! and `sustika2015`; [`paper`] has their names and simulations.
//!
//! # A step by hand
//!
//! Two modes, one that hardly moves and one that moves a lot. Each filter has one state component. The comments show the arithmetic:
//!
//! ```
//! use immaculate::filter::Filter;
//! use immaculate::gaussian::Gaussian;
//! use immaculate::imm::{Imm, Initial, Interaction, Problem};
//! use immaculate::model::{Sensor, motion::{Mode, Motion}};
//! use nalgebra::{matrix, vector};
//!
//! let mode = |name: &str, noise: f64| {
//!     Mode { name: name.into(), motion: Motion::Linear(matrix![1.0]), noise: matrix![noise] }
//! };
//! let problem = Problem {
//!     modes: vec![mode("quiet", 1.0), mode("lively", 13.0)],
//!     chain: vec![vec![0.5, 0.5], vec![0.5, 0.5]], // row i: from mode i
//!     sensor: Sensor::Linear(matrix![1.0]),
//!     measurement_noise: matrix![1.0],
//!     filters: vec![Filter::kalman()],
//!     interaction: Interaction::Imm,
//!     angles: vec![],
//! };
//! let at = |x: f64| Gaussian { mean: vector![x], covariance: matrix![1.0] };
//! let initial = Initial { modes: vec![at(1.0), at(3.0)], mode_probabilities: vec![0.5, 0.5] };
//! let mut filter = Imm::new(problem, &initial)?;
//! let step = filter.step(Some(&vector![2.0]))?;
//!
//! // Where the modes come from: c = ½ · ½ + ½ · ½, and of that ½ · ½ from either.
//! assert_eq!(step.predicted_mode_probabilities, [0.5, 0.5]);
//! assert_eq!(step.mixing_probabilities, [[0.5, 0.5], [0.5, 0.5]]);
//! // Both start from the mixture of 1 and 3: mean 2, variance 1 and the spread of the means, 1.
//! assert_eq!(step.mixed[0], Gaussian { mean: vector![2.0], covariance: matrix![2.0] });
//! // Prediction: 2 + 1 and 2 + 13. Innovation: 2 − 2, with 3 + 1 and 15 + 1.
//! assert_eq!([0, 1].map(|j| step.predicted[j].covariance[0]), [3.0, 15.0]);
//! assert_eq!([0, 1].map(|j| step.innovation_covariances[j][0]), [4.0, 16.0]);
//! // Update: gains 3/4 and 15/16, variances 3 − 9/4 and 15 − 225/16.
//! assert_eq!([0, 1].map(|j| step.gains[j][0]), [0.75, 0.9375]);
//! assert_eq!([0, 1].map(|j| step.updated[j].covariance[0]), [0.75, 0.9375]);
//! // Both predictions are hit, which speaks for the mode that was the surer:
//! // 1/√4 to 1/√16, so 2/3 to 1/3. (A logarithm and an exponential of it are rounded in their last place.)
//! assert!((step.mode_probabilities[0] - 2.0 / 3.0).abs() <= 2.0 * f64::EPSILON);
//! // For output: 2/3 · 3/4 + 1/3 · 15/16 = 13/16, and no spread, for both means are 2.
//! assert_eq!(step.combined.mean, vector![2.0]);
//! assert!((step.combined.covariance[0] - 0.8125).abs() <= 2.0 * f64::EPSILON);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The rooms, in reading order
//!
//! A room uses only rooms above it. The rooms without a feature are the specification; `default-features = false` builds only these. The
//! oracle and the papers do not use each other. The default feature, `cli`, includes both.
//!
//! | room           | contents                                                                           | feature           |
//! |----------------|------------------------------------------------------------------------------------|-------------------|
//! | [`number`]     | the number systems in which every equation is evaluated                            |                   |
//! | [`matrix`]     | Cholesky and L D Lᵀ, for every number system                                       |                   |
//! | [`gaussian`]   | moments of a mixture, density of a residual                                        |                   |
//! | [`model`]      | motion of the target, measurement of the sensor                                    |                   |
//! | [`rule`]       | cubature rules in exact form, their moments and degrees                            |                   |
//! | [`filter`]     | one filter: Kalman, cubature, converted measurements, fixed gain                   |                   |
//! | [`imm`]        | the cycle: a table of equations and the wiring that runs it                        |                   |
//! | [`smoother`]   | past states given later measurements, of one filter or of several that switch      |                   |
//! | [`mod@file`]   | bounded reading, atomic writing                                                    | `oracle`, `paper` |
//! | [`oracle`]     | certified cases, traces, and the judge of other filters                            | `oracle`          |
//! | [`steady`]     | steady gains, Riccati and Lyapunov equations, joint stability and its certificates | `paper`           |
//! | [`statistics`] | errors over runs, their uncertainty, consistency                                   | `paper`           |
//! | [`paper`]      | the papers' simulations, published tables and claims, and their judges             | `paper`           |
//! | [`compare`]    | every kind of filter on the simulated truth of a problem                           | `cli`             |
//! | [`book`]       | every equation with its code, derivation, errata, tests, mistakes and cases        | `cli`             |
//! | [`report`]     | printed text, figures and the site                                                 | `cli`             |
//! | `cli`          | the commands of the program                                                        | `cli`             |
//!
//! Equations, filters and the cycle read no files, draw no random numbers and print nothing. To read only the filter, read
//! [`gaussian`], [`filter`] and [`imm`], in that order.
//!
//! # From a paper's section to its room
//!
//! | section                     | equations              | rooms                                                           |
//! |-----------------------------|------------------------|-----------------------------------------------------------------|
//! | zhu2016 2.1, points         | zhu2016 (1)-(8)        | [`matrix`], [`filter::cubature`]                                |
//! | 2.1, directions and weights | zhu2016 (9)-(13)       | [`rule::fifth_degree`]                                          |
//! | 2.1, prediction             | zhu2016 (14)-(26)      | [`filter::cubature`], [`filter::raw`]                           |
//! | 2.2, fresh points           | zhu2016 (27)-(34)      | [`matrix`], [`filter::cubature`]                                |
//! | 2.2, what they measure      | zhu2016 (35)-(44)      | [`model::sensor`]                                          |
//! | 2.2, its covariances        | zhu2016 (45)-(50)      | [`filter::raw`]                                                 |
//! | 2.2, update                 | zhu2016 (51)-(53)      | [`filter::update`]                                              |
//! | 3.1, input                  | zhu2016 (54)-(56)      | [`imm::probability`], [`gaussian`]                              |
//! | 3.3, model probabilities    | zhu2016 (57), (58)     | [`gaussian`], [`imm::probability`]                              |
//! | 3.4, output                 | zhu2016 (59), (60)     | [`gaussian`]                                                    |
//! | 4, models                   | zhu2016 (61), (62)     | [`model::motion`], [`model::sensor`]                       |
//! | 4, simulation               | zhu2016 (63), (64)     | [`paper::zhu2016`], [`statistics::rmse`]                        |
//! | liu2017 2, problem          | liu2017 (1)            | [`model::motion`], [`model::sensor`]                       |
//! | 2.1, the rule               | liu2017 (2)-(11)       | [`rule`], [`rule::sphere`], [`rule::simplex`]                   |
//! | 3, step 1, interaction      | liu2017 (12), (13)     | [`gaussian`], [`imm::probability`]                              |
//! | 3, step 2, points           | liu2017 (14)-(16)      | [`filter::cubature`], [`rule::simplex`]                         |
//! | 3, step 2, prediction       | liu2017 (17)           | [`filter::cubature`]                                            |
//! | 3, step 2, measurement      | liu2017 (18), (19)     | [`filter::cubature`], [`model::sensor`]                    |
//! | 3, step 2, update           | liu2017 (20)           | [`filter::update`]                                              |
//! | 3, steps 3 and 4            | liu2017 (21)-(24)      | [`gaussian`], [`imm::probability`]                              |
//! | 4.1, models                 | liu2017 (25)-(31)      | [`model::motion`], [`model::sensor`]                       |
//! | 4.2, simulation             | liu2017 (32)-(34)      | [`paper::liu2017`], [`statistics::rmse`]                        |
//! | derbez2000 2.1, mixing      | derbez2000 (1), (3)    | [`gaussian`], [`imm::probability`]                              |
//! | 2.1, the filters            | derbez2000 (2), (4)    | [`filter::kalman`], [`filter::update`]                          |
//! | 2.2, the models             | derbez2000 (5), (6)    | [`model::acceleration`]                                         |
//! | 2.2, the long-term error    | derbez2000 (7), (8)    | [`steady::mismatch`], [`filter::update`], [`steady::long_term`] |
//! | 3, fixed gains              | not numbered           | [`filter::fixed_gain`], [`imm::problem`], [`steady::gains`]     |
//! | 3, their equilibrium        | not numbered           | [`steady::riccati`], [`steady::reach`]                          |
//! | 3.1, stability              | not numbered           | [`steady::perturbation`], [`steady::pair`], [`steady::verdict`] |
//! | 4, simulation               | not numbered           | [`paper::derbez2000`]                                           |
//! | sustika2015 2.1, motion     | sustika2015 (1)        | [`model::motion`], [`model::wiener`]                            |
//! | 2.1, measurement            | sustika2015 (2)-(4)    | [`model::sensor`], [`imm::problem`]                        |
//! | 2.2, the filter             | sustika2015 (5)-(13)   | [`imm::probability`], [`gaussian`], [`imm::unequal`]            |
//! | 3.1, Kalman filter          | sustika2015 (14)-(19)  | [`filter::kalman`], [`filter::update`]                          |
//! | 3.1, converted measurements | sustika2015 (20)-(26)  | [`model::conversion`], [`filter::converted`]                    |
//! | 3.2, points                 | sustika2015 (27)-(29)  | [`filter::cubature`], [`rule::unscented`]                       |
//! | 3.2, what they measure      | sustika2015 (30), (31) | [`model::sensor`]                                          |
//! | 3.2, its covariances        | sustika2015 (32), (33) | [`filter::cubature`]                                            |
//! | 3.2, update                 | sustika2015 (34)-(36)  | [`filter::update`]                                              |
//! | 4 and 5, simulation         | sustika2015 (37)-(39)  | [`statistics::fit_error`], [`paper::sustika2015`]               |
//!
//! # From a printed number to everything about it
//!
//! The first line of a doc comment ends with the numbers of the equations that its item implements, in one fixed form after a dash:
//! `zhu2016 (56), liu2017 (12)`, or `zhu2016 (14)-(20)` for several in a row. A search for
//! `zhu2016 (56)` finds single numbers, here and in the source, and
//!
//! ```text
//! immaculate equation "zhu2016 56"
//! ```
//!
//! shows the equation with its LaTeX, status and erratum, its function, its tests, the cases that judge it and the known mistakes.
//! The parts of its doc comment have a fixed order:
//!
//! | part       | contents                                                                                 |
//! |------------|------------------------------------------------------------------------------------------|
//! | first line | the name, and the printed numbers                                                        |
//! | formula    | in the papers' letters                                                                   |
//! | table      | each letter, the name it has here, its shape or unit                                     |
//! | `Why`      | the derivation; `Source` if no paper prints it                                           |
//! | `Example`  | by hand, with exact numbers, and often the result of a famous mistake; all run as tests  |
//! | `Errors`   | when there is no result                                                                  |
//! | `Errata`   | what the papers print instead                                                            |
//! | `Evidence` | the tests in `tests/`, and their kind: exact, symbolic, enclosed, property, consistency  |
//!
//! The way back leads from code to paper: [`Quantity::equation`](imm::Quantity::equation) gives the equation numbers of a traced value,
//! and every error of a run names the equation that had no result. `spec/` has every equation, erratum, open parameter and claim as data.
//!
//! # The command line
//!
//! | command                          | does                                                                             |
//! |----------------------------------|----------------------------------------------------------------------------------|
//! | `immaculate equation ID`         | shows an equation with its code, tests, cases and mistakes                       |
//! | `immaculate report --out DIR`    | writes the whole specification and its results as a static site                  |
//! | `immaculate reproduce`, `claims` | runs the papers' simulations beside their tables; judges their claims            |
//! | `immaculate check -- COMMAND`    | judges a filter in any language: whether it is right, or what is wrong and why  |
//! | `immaculate compare FILE`        | which filter to use for a problem: every kind of filter on simulated truth      |
//! | `immaculate cases`, `trace FILE` | the certified cases; every value of every step of a problem                      |
//! | `immaculate variants`, `rule`    | the catalogue of mistakes, conventions and forms; points and weights of a rule   |
//! | `immaculate stability`           | whether two fixed-gain filters are stable together, with a proof                 |
//!
//! Every command has `--help`.

pub mod filter;
pub mod gaussian;
pub mod imm;
pub mod matrix;
pub mod model;
pub mod number;
pub mod rule;
pub mod smoother;

#[cfg(any(feature = "oracle", feature = "paper"))]
pub mod file;

#[cfg(feature = "oracle")]
pub mod oracle;

#[cfg(feature = "paper")]
pub mod paper;
#[cfg(feature = "paper")]
pub mod statistics;
#[cfg(feature = "paper")]
pub mod steady;

#[cfg(feature = "cli")]
pub mod book;
#[cfg(feature = "cli")]
pub mod compare;
#[cfg(feature = "cli")]
pub mod report;

/// The examples of README and of the pages for users are run with the others.
#[cfg(all(doctest, feature = "cli"))]
#[doc = include_str!("../README.md")]
struct Readme;
#[cfg(all(doctest, feature = "cli"))]
#[doc = include_str!("../spec/library.md")]
struct Library;
