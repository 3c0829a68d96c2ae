"""The natural unit of every number of a step: `scale` of a trace, before it is rounded to three digits (spec/formats.md, "A trace")."""

from flint import arb

from balls import Undecided


def units_of(values, given):
    """The units in the shape of the values; `given` are gains and innovation covariances of filters that have no covariances."""
    fixed = fixed_deviations(given) if given else None
    units = {
        "predicted_mode_probabilities": [of_probability(p) for p in values["predicted_mode_probabilities"]],
        "modes": [of_mode(mode, fixed) for mode in values["modes"]],
        "mode_probabilities": [of_probability(p) for p in values["mode_probabilities"]],
    }
    for name in ("combined_prediction", "combined"):
        units[name] = of_estimate(values[name], fixed)
    if "nees" in values:
        units["nees"] = arb(1)
    if "converted_covariance" in values:
        deviations = deviations_of(values["converted_covariance"])
        units |= {"converted_measurement": deviations, "converted_covariance": products(deviations, deviations)}
    return units


def of_mode(mode, fixed):
    """The units of a mode's values."""
    units = {name: of_estimate(mode[name], fixed) for name in ("mixed", "predicted", "updated")}
    units["mixing_probabilities"] = [of_probability(p) for p in mode["mixing_probabilities"]]
    before, state = units["mixed"]["mean"], units["predicted"]["mean"]
    if "motion_jacobian" in mode:
        units["motion_jacobian"] = quotients(state, before)
    if "innovation" not in mode:
        return units
    measured = deviations_of(mode["innovation_covariance"])
    return units | {
        "predicted_measurement": measured,
        "innovation": measured,
        "measurement_jacobian": quotients(measured, state),
        "innovation_covariance": products(measured, measured),
        "cross_covariance": products(state, measured),
        "gain": quotients(state, measured),
        "log_likelihood": arb(1),
        "nis": arb(1),
    }


def of_estimate(estimate, fixed):
    if estimate.covariance is None:
        return {"mean": fixed}
    deviations = deviations_of(estimate.covariance)
    return {"mean": deviations, "covariance": products(deviations, deviations)}


def deviations_of(covariance):
    """√Pᵢᵢ, and 1 where there is no variance."""
    return [deviation(covariance[i, i]) for i in range(covariance.nrows())]


def deviation(variance):
    if variance.is_zero():
        return arb(1)
    if variance.contains(0):
        raise Undecided("whether there is a variance")
    return variance.sqrt()


def fixed_deviations(given):
    """With fixed gains: √(K S Kᵀ)ᵢᵢ of the mode where it is greatest."""
    moved = [filter["gain"] * filter["innovation_covariance"] * filter["gain"].transpose() for filter in given]
    size = moved[0].nrows()
    return [deviation(max((m[i, i] for m in moved), key=lambda variance: float(variance.mid()))) for i in range(size)]


def of_probability(probability):
    """Itself, and the least unit there is for a probability of zero."""
    return arb(10) ** -300 if probability.is_zero() or probability < arb(10) ** -300 else probability


def products(rows, columns):
    return [[row * column for column in columns] for row in rows]


def quotients(rows, columns):
    return [[row / column for column in columns] for row in rows]
