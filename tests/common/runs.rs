//! The papers' simulations at three runs: enough to draw, and to see what is drawn.

use immaculate::paper::result::Reproduction;
use immaculate::paper::specification::Choices;
use immaculate::paper::{Effort, Paper};

/// Few runs are enough to draw.
pub const EFFORT: Effort = Effort { runs: Some(3), seed: 1 };

/// A simulation of each kind of each paper.
pub fn reproductions() -> Vec<Reproduction> {
    let of_paper = |paper: Paper| {
        let simulations = paper.simulations(&Choices::default());
        simulations
            .into_iter()
            .map(move |choices| paper.reproduce(&choices, EFFORT, &|| ()).unwrap())
    };
    Paper::ALL.into_iter().flat_map(of_paper).collect()
}
