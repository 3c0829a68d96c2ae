"""The cycle of the interacting multiple model filter: mix, predict, update, weigh, combine.

`run` gives for each step the values of a trace, as nested dictionaries and lists of balls, under the names of spec/formats.md.
"""

from flint import arb

from balls import Undecided, column, entries, is_zero, wrap, wrap_rows, zeros
from filters import Estimate, moments, squared_distance, update, update_with_given_gain


def run(problem):
    """The values of all steps."""
    probabilities, estimates = problem.probabilities, problem.estimates
    steps = []
    for at in problem.steps:
        values, probabilities, estimates = step(problem, at, probabilities, estimates)
        steps.append(values)
    return steps


def step(problem, at, probabilities, estimates):
    """One step, from the estimates and probabilities at k−1 to those at k."""
    seen, converted = problem.seen(at)
    predicted_probabilities, mixing = mix_probabilities(problem.chain(at), probabilities)
    mixing = weights_of_the_start(problem, mixing, probabilities)
    modes, predictions, updates = [], [], []
    for j, weights in enumerate(mixing):
        angles = problem.angles_of[j]
        mixed = mixture(weights, problem.read(estimates, j, at), angles)
        predicted, values = predict(problem, j, at, mixed)
        seen_by_mode = seen and problem.seen_by(j, seen, at)
        updated, seen_values = (predicted, {}) if seen is None else see(problem.filters[j], predicted, seen_by_mode)
        updated = Estimate(wrap_rows(updated.mean, angles), updated.covariance)
        estimates_of_mode = {"mixed": mixed, "predicted": predicted, "updated": updated}
        modes.append({"mixing_probabilities": weights, **estimates_of_mode, **values, **seen_values})
        predictions.append(predicted)
        updates.append(updated)
    logarithms = None if seen is None else [mode["log_likelihood"] for mode in modes]
    weighed = weigh(predicted_probabilities, logarithms)
    values = {
        "predicted_mode_probabilities": predicted_probabilities,
        "modes": modes,
        "combined_prediction": mixture(predicted_probabilities, problem.read(predictions, None, at), problem.angles),
        **converted,
        "mode_probabilities": weighed,
        "combined": mixture(weighed, problem.read(updates, None, at), problem.angles),
    }
    if "truth" in at:
        error = wrap_rows(problem.truth(at) - values["combined"].mean, problem.angles)
        values["nees"] = squared_distance(error, values["combined"].covariance)
    return values, weighed, updates


def mix_probabilities(chain, probabilities):
    """zhu2016 (54): C_j = Σᵢ p_ij μⁱ and μ^(i∣j) = p_ij μⁱ/C_j. A mode that cannot be reached keeps its own estimate."""
    modes = range(len(probabilities))
    predicted = [sum((chain[i][j] * probabilities[i] for i in modes), arb(0)) for j in modes]
    mixing = []
    for j in modes:
        if is_zero(predicted[j]):
            mixing.append(unit(j, len(modes)))
        else:
            mixing.append([chain[i][j] * probabilities[i] / predicted[j] for i in modes])
    return predicted, mixing


def weights_of_the_start(problem, mixing, probabilities):
    """Of which estimates each mode starts: mixed ones, its own, or (GPB1, Bar-Shalom et al. 2001, 11.6.4) the combined one, μ^(i∣j) = μⁱ."""
    modes = len(mixing)
    kind = problem.raw.get("interaction", problem.raw["filter"].get("mixing"))
    if kind == "gpb1":
        return [probabilities] * modes
    return [unit(j, modes) for j in range(modes)] if kind == "unmixed" else mixing


def unit(j, size):
    return [arb(int(i == j)) for i in range(size)]


def mixture(weights, estimates, angles):
    """zhu2016 (55), (56) and (59), (60): mean and covariance of a mixture, with the spread of the means.

    Angles are averaged in the turn of the first estimate's; differences from the mean are wrapped.
    """
    reference = estimates[0].mean
    mean = zeros(len(angles), 1)
    for weight, estimate in zip(weights, estimates):
        mean += in_turn_of(reference, estimate.mean, angles) * weight
    if estimates[0].covariance is None:
        return Estimate(mean, None)
    covariance = zeros(len(angles), len(angles))
    for weight, estimate in zip(weights, estimates):
        away = wrap_rows(estimate.mean - mean, angles)
        covariance += (estimate.covariance + away * away.transpose()) * weight
    return Estimate(mean, covariance)


def in_turn_of(reference, vector, angles):
    """The same vector, its angles within half a turn of the reference's."""
    rows = zip(entries(reference), entries(vector), angles)
    return column([r + wrap(x - r) if angle else x for r, x, angle in rows])


def predict(problem, j, at, mixed):
    """liu2017 (17), and its kin: the moments of the motion, and Q once."""
    filter, function = problem.filters[j], problem.motion(j, at)
    if filter["kind"] == "fixed-gain":
        return Estimate(function.at(mixed.mean), None), {}
    found = moments(filter, function, mixed, problem.angles_of[j])
    values = {} if found.jacobian is None else {"motion_jacobian": found.jacobian}
    return Estimate(found.mean, found.covariance + problem.noise(j, at)), values


def see(filter, predicted, seen):
    return (update_with_given_gain if filter["kind"] == "fixed-gain" else update)(filter, predicted, seen)


def weigh(predicted, logarithms):
    """zhu2016 (58), in logarithms: μʲ = LʲC_j/Σ LⁱC_i. Without a measurement they are the predicted ones."""
    if logarithms is None:
        return predicted
    greatest = max((log for log, p in zip(logarithms, predicted) if not p.is_zero()), key=lambda log: float(log.mid()))
    parts = [p if p.is_zero() else p * (log - greatest).exp() for p, log in zip(predicted, logarithms)]
    evidence = sum(parts, arb(0))
    if evidence.contains(0):
        raise Undecided("the evidence")
    return [part / evidence for part in parts]
