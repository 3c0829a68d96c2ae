//! The faults of a verdict, equation by equation: the first in a sentence, and the number of others.
//!
//! The text, the HTML page, the Markdown summary and the test report all use these sentences.

use super::check::number;
use crate::imm::Quantity;
use crate::oracle::check::{CaseReport, Report};
use crate::oracle::judge::{Finding, Judged, Judgement};
use crate::oracle::subject::Precision;

/// The faulty values of one equation, of which there is one at least.
pub(super) struct FaultyEquation<'a> {
    pub quantity: Quantity,
    /// Whether forms and conventions explain them, so that they are not wrong.
    pub is_otherwise: bool,
    /// The first faulty value, and the case in which it is.
    pub case: &'a CaseReport,
    pub first: &'a Judged,
    /// All of them, each with its case.
    pub values: Vec<(&'a CaseReport, &'a Judged)>,
}

/// The equations with a fault, in the order in which they are computed.
pub(super) fn faulty_equations(report: &Report) -> Vec<FaultyEquation<'_>> {
    of_values(report, &report.faults().collect::<Vec<_>>())
}

/// Those of one case.
pub(super) fn faulty_equations_of<'a>(report: &'a Report, case: &'a CaseReport) -> Vec<FaultyEquation<'a>> {
    let faults = case.judgement.iter().flat_map(Judgement::faults);
    of_values(report, &faults.map(|judged| (case, judged)).collect::<Vec<_>>())
}

fn of_values<'a>(report: &Report, faults: &[(&'a CaseReport, &'a Judged)]) -> Vec<FaultyEquation<'a>> {
    let mut equations = Vec::new();
    for quantity in Quantity::ALL {
        let of_quantity = faults.iter().filter(|(_, judged)| judged.place.1 == quantity);
        let values: Vec<_> = of_quantity.copied().collect();
        if let Some(&(case, first)) = values.first() {
            equations.push(FaultyEquation {
                quantity,
                is_otherwise: report.is_otherwise(quantity),
                case,
                first,
                values,
            });
        }
    }
    equations
}

impl FaultyEquation<'_> {
    /// What the faults are called.
    pub fn heading(&self) -> &'static str {
        if self.is_otherwise { "OTHERWISE" } else { "FAULT" }
    }

    /// The printed equations.
    pub fn equation(&self) -> &'static str {
        self.case.equation(self.quantity, self.first.place.2)
    }

    /// The first fault: where, what is shown, what it should be, and how far it is off.
    pub fn sentence(&self, precision: Precision) -> String {
        first_fault(self.case, self.first, precision)
    }

    /// Which equations may have the fault in its place, since their values are not shown.
    pub fn hidden(&self) -> Option<String> {
        if self.first.hidden.is_empty() {
            return None;
        }
        let names: Vec<&str> = self.first.hidden.iter().map(|quantity| quantity.name()).collect();
        Some(format!(
            "The fault is in this equation or in an earlier one that is not shown: {}.",
            names.join(", ")
        ))
    }

    /// How many more faults there are, and in how many cases.
    pub fn others(&self) -> Option<String> {
        if self.values.len() == 1 {
            return None;
        }
        let mut cases: Vec<&str> = self.values.iter().map(|(case, _)| case.id.as_str()).collect();
        cases.dedup();
        let others = match cases.len() - 1 {
            0 => String::new(),
            1 => " and one other".into(),
            others => format!(" and {others} others"),
        };
        let more = self.values.len() - 1;
        Some(format!("And {more} more of these values, in this case{others}."))
    }
}

/// The place of a number inside its quantity.
fn entry(judged: &Judged, index: usize, report: &CaseReport) -> String {
    let quantity = judged.place.1;
    let columns = report.columns(judged.place.0, quantity);
    match quantity.rank() {
        0 => String::new(),
        1 => format!("[{index}]"),
        _ => format!("[{}][{}]", index / columns, index % columns),
    }
}

fn first_fault(case: &CaseReport, judged: &Judged, precision: Precision) -> String {
    let (step, quantity, mode) = judged.place;
    let of_mode = if quantity.is_of_mode() {
        format!("modes[{mode}].")
    } else {
        String::new()
    };
    let place = format!("{}, step {step}, {of_mode}{}", case.id, quantity.name());
    let Some(own) = judged.own else {
        return format!("{place}: the value is not finite.");
    };
    if judged.finding == Finding::NotFinite {
        return format!(
            "{place}: the value is not finite; the program's own values give {}.",
            own.expected
        );
    }
    let noise = if own.ratio.is_finite() {
        format!("{:.0e} times", own.ratio)
    } else {
        "infinitely many times".into()
    };
    format!(
        "{place}{} is {}, and should be {}, given the program's own earlier values: off by {:.2e}{}, {noise} the rounding noise of {precision}.",
        entry(judged, own.index, case),
        number(own.shown),
        number(own.expected),
        own.size,
        unit(quantity),
    )
}

/// The unit of a quantity's errors, after a blank; empty if it has none.
pub(super) fn unit(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::PredictedModeProbabilities | Quantity::MixingProbabilities | Quantity::ModeProbabilities => {
            " of its own size"
        }
        Quantity::LogLikelihood | Quantity::Nis | Quantity::Nees => "",
        Quantity::Gain => " √(Pᵢᵢ/Sⱼⱼ)",
        Quantity::MotionJacobian => " √(P⁻ᵢᵢ/P⁰ⱼⱼ)",
        Quantity::MeasurementJacobian => " √(Sᵢᵢ/P⁻ⱼⱼ)",
        Quantity::CrossCovariance => " √(Pᵢᵢ Sⱼⱼ)",
        quantity if quantity.is_covariance() => " √(Pᵢᵢ Pⱼⱼ)",
        _ => " standard deviations",
    }
}
