//! The claims of sustika2015, each with its judge.
//!
//! They decide which filter is better where, by how much and how surely, and what made the unscented filter diverge. The claims are in
//! `spec/sustika2015/claims.toml`, in the same order. Every judge computes its evidence and is called once in [`judge`]. The judges that
//! need no runs are in [`reasoning`].
//!
//! - `evidence`: the runs that the judges share, and how two filters are compared;
//! - `straight`: section 5.1, scenarios 1 and 2 without manoeuvres;
//! - `manoeuvring`: section 5.2, the same with manoeuvres;
//! - `noises`: scenario 3, and the cause of the divergence;
//! - `conclusion`: section 6;
//! - `reachable`: whether anything gives tables 4 and 5.

mod conclusion;
mod evidence;
mod manoeuvring;
mod noises;
mod reachable;
mod straight;

pub use evidence::ratio_less;
pub use manoeuvring::the_window_decides;
pub use noises::is_mismatch_the_cause;

use super::reasoning;
use crate::paper::Effort;
use crate::paper::monte_carlo::Progress;
use crate::paper::specification::{InvalidChoice, sustika2015 as specification};
use crate::paper::verdict::JudgedClaim;
use evidence::RadarEvidence;

/// Judges every claim.
///
/// # Errors
///
/// [`InvalidChoice`] when the specification lacks an alternative that a judge asks for.
pub fn judge(effort: Effort, progress: Progress) -> Result<Vec<JudgedClaim>, InvalidChoice> {
    let s = specification();
    let runs = RadarEvidence::new(effort, progress)?;
    Ok(vec![
        manoeuvring::better_when_manoeuvring(s, &runs),
        noises::more_robust(s, &runs),
        reasoning::difficult_jacobian(),
        reasoning::kalman_needs_modification(),
        reasoning::exact_moments(),
        straight::better_without_mismatch(s, &runs),
        straight::better_on_all_scenarios(s, &runs),
        straight::below_three_per_cent(s, &runs),
        noises::no_difference_without_manoeuvre(s, &runs),
        noises::mismatch_no_problem(s, &runs),
        manoeuvring::large_error_in_manoeuvres(s, &runs),
        manoeuvring::mismatch_hurts_manoeuvres(s, &runs),
        manoeuvring::larger_error_in_figure_3(s, &runs),
        manoeuvring::almost_the_same(s, &runs),
        manoeuvring::better_in_scenario_2(s, &runs),
        noises::divergence(s, &runs),
        noises::cause_of_divergence(s, &runs),
        reasoning::execution_time(),
        reasoning::no_linearisation(),
        conclusion::a_little_better_without_mismatch(s, &runs),
        conclusion::better_with_mismatch(s, &runs),
        conclusion::bad_in_manoeuvres(s, &runs),
        conclusion::suitable(s, &runs),
        reachable::tables_reachable(s, &runs),
    ])
}
