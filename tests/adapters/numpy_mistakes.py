"""Mistakes to plant in the filter of numpy_imm.py, each written as a programmer would make it.

The names are those of the catalogue, spec/variants.toml; nothing else is shared with it. Each
class overrides the method in which the mistake is made, so several can be planted at once.
"""

import math

import numpy as np
from numpy_imm import mixture


class TransitionTransposed:
    """The chain is stored by columns: chain[j, i]."""

    def given(self, **arguments):
        super().given(**arguments)
        self.chain = self.chain.T


class TransitionTransposedInMixing:
    """The row in place of the column."""

    def mixing_probabilities(self, mode, predicted):
        if predicted[mode.index] == 0:
            return super().mixing_probabilities(mode, predicted)
        return self.chain[mode.index, :] * self.mode_probabilities / predicted[mode.index]


class ChainByAnEulerStep:
    """I + G T instead of the matrix exponential."""

    def chain_over(self, rates, interval):
        return np.eye(len(rates)) + rates * interval


class SojournTimesAsRates:
    """tau instead of 1/tau."""

    def rates_of(self, sojourn_times, jumps):
        return (jumps - np.eye(len(jumps))) * sojourn_times[:, None]


class MixingWithModeProbabilitiesAlone:
    """GPB1 under the name of IMM: the chain has no say in where a mode starts."""

    def mixing_probabilities(self, mode, predicted):
        return self.mode_probabilities


class CommonStartMixedByTheChain:
    """IMM under the name of GPB1."""

    def mixing_probabilities(self, mode, predicted):
        joint = self.chain[:, mode.index] * self.mode_probabilities
        return joint / predicted[mode.index]


class MixingSkipped:
    """Every mode goes on from its own estimate."""

    def mixed(self, mode):
        return self.estimates[mode.index]


class MixedSpreadOmitted:
    """The covariances are averaged, the spread of the means is forgotten."""

    def mixed(self, mode):
        mean, _ = super().mixed(mode)
        estimates = self.read(self.estimates, mode.index)
        return mean, sum(w * p for w, (_, p) in zip(mode.mixing_probabilities, estimates))


class CovariancesNotMixed:
    """Means are mixed, covariances are not."""

    def mixed(self, mode):
        mean, _ = super().mixed(mode)
        return mean, self.estimates[mode.index][1]


class ProcessNoiseOmitted:
    """Q is never added."""

    def given(self, **arguments):
        arguments["process_noises"] = [
            np.zeros_like(noise) for noise in arguments["process_noises"]
        ]
        super().given(**arguments)


class ProcessNoiseDoubled:
    """Q is added by the points' moments, and once more after them."""

    def predicted(self, mode):
        mean, covariance = super().predicted(mode)
        return mean, covariance + self.process_noises[mode.index]


class PointsNotDrawnAfresh:
    """The propagated points are measured."""

    def measured_points(self, mode):
        motion = self.motions[mode.index]
        return np.stack([motion.of(point) for point in self.points(mode.mixed)])


class PointsFromRowsOfTheRoot:
    """The factor is applied from the wrong side: its rows move the points, not its columns."""

    def points(self, estimate):
        mean, covariance = estimate
        return mean + self.rule[0] @ self.root(covariance)


class Cubature5Weight13:
    """The diagonals' weight as zhu2016 (13) prints it: 2/(n + 2)^2."""

    def __init__(self, **arguments):
        points = arguments["rule"] and arguments["rule"][0]
        if points is not None and len(points) == 2 * points.shape[1] ** 2 + 1:
            n = points.shape[1]
            weights = arguments["rule"][1].copy()
            weights[1 + 2 * n :] = 2 / (n + 2) ** 2
            if n > 1 and math.isclose(arguments["rule"][1][0], 2 / (n + 2), rel_tol=1e-6):
                arguments["rule"] = (points, weights, weights)
        super().__init__(**arguments)


class ConvertedCovarianceNotRotated:
    """The variances along and across the line of sight are used for x and y."""

    def converted_covariance(self, z):
        distance = z[self.conversion.rows[0]]
        return np.diag(self.conversion.variances(distance))


class ConvertedCovarianceCrossTermOfOtherSign:
    """A slip of sign in sustika2015 (26)."""

    def converted_covariance(self, z):
        return super().converted_covariance(z) * np.array([[1, -1], [-1, 1]], self.number)


class MeasurementNoiseDoubled:
    """R is in S already, and is added again."""

    def measure(self, mode):
        super().measure(mode)
        mode.innovation_covariance = mode.innovation_covariance + self.measurement_noise


class MeasurementNoiseOmitted:
    """S = H P H'."""

    def measure(self, mode):
        noise, self.measurement_noise = self.measurement_noise, 0 * self.measurement_noise
        super().measure(mode)
        self.measurement_noise = noise


class InnovationNotWrapped:
    """z - z_predicted as plain numbers."""

    def innovation(self, mode, z):
        return z - mode.predicted_measurement


class MeasurementOfTheMean:
    """The measurement of the mean for the mean of the measurements."""

    def measure(self, mode):
        full = self.measurement
        self.measurement = MeasuredMean(full)
        super().measure(mode)
        self.measurement = full


class MeasuredMean:
    """A measurement whose mean is that of the centre."""

    def __init__(self, measurement):
        self.matrix = measurement.matrix
        self.of_states = measurement.of_states
        self.difference = measurement.difference
        self.slope = measurement.slope

    def mean(self, weights, values, centre):
        return centre


class GainOfMixedCovariance:
    """The gain is computed before the prediction of the covariance; a Kalman filter's mistake."""

    def gain(self, mode):
        if self.rule is not None:
            return super().gain(mode)
        matrix, covariance = self.measured_slope(mode, mode.predicted[0]), mode.mixed[1]
        s = matrix @ covariance @ matrix.T + self.measurement_noise
        return covariance @ matrix.T @ np.linalg.inv(s)


class CovarianceNotUpdated:
    """Only the mean is updated."""

    def updated(self, mode):
        mean, _ = super().updated(mode)
        return mean, mode.predicted[1]


class DeterminantOmitted:
    """exp(-d^2/2), normalised by 2 pi alone."""

    def log_likelihood(self, mode):
        residual = mode.innovation
        square = residual @ np.linalg.solve(mode.innovation_covariance, residual)
        return -square / 2 - self.two_pi(mode)


class ExponentWithoutHalf:
    """exp(-d^2)."""

    def log_likelihood(self, mode):
        s, residual = mode.innovation_covariance, mode.innovation
        square = residual @ np.linalg.solve(s, residual)
        return -square - np.log(np.linalg.det(s)) / 2 - self.two_pi(mode)


class LikelihoodOfUpdatedResidual:
    """The residual after the update in place of the innovation."""

    def log_likelihood(self, mode):
        s = mode.innovation_covariance
        z = mode.innovation + mode.predicted_measurement
        measured = self.measured(mode, mode.updated[0][None, :])[0]
        residual = self.measurement.difference(z, measured)
        square = residual @ np.linalg.solve(s, residual)
        return -(square + np.log(np.linalg.det(s))) / 2 - self.two_pi(mode)


class UpdatedWithOldProbabilities:
    """mu_j(k-1) L_j in place of c_j L_j."""

    def updated_probabilities(self, now):
        logs = np.array([mode.log_likelihood for mode in now.modes], self.number)
        reachable = self.mode_probabilities > 0
        relative = np.where(reachable, logs - np.max(logs[reachable]), -np.inf)
        weights = self.mode_probabilities * np.exp(relative)
        return weights / np.sum(weights)


class PriorOmitted:
    """L_j / sum of L."""

    def updated_probabilities(self, now):
        logs = np.array([mode.log_likelihood for mode in now.modes], self.number)
        weights = np.exp(logs - np.max(logs))
        return weights / np.sum(weights)


class ProbabilitiesNotAdvanced:
    """Nothing is done without a detection, with the probabilities either."""

    def undetected_probabilities(self, now):
        return self.mode_probabilities


class LastLikelihoodUsedAgain:
    """The likelihoods of the last detection still stand in their variables."""

    likelihoods = None

    def updated_probabilities(self, now):
        self.likelihoods = [mode.log_likelihood for mode in now.modes]
        return super().updated_probabilities(now)

    def undetected_probabilities(self, now):
        if self.likelihoods is None:
            return now.predicted_mode_probabilities
        reachable = now.predicted_mode_probabilities > 0
        logs = np.where(reachable, self.likelihoods, -np.inf)
        weights = now.predicted_mode_probabilities * np.exp(logs - np.max(logs))
        return weights / np.sum(weights)


class CombinedSpreadOmitted:
    """The covariances are averaged, the spread of the means is forgotten."""

    def combined(self, now):
        mean, _ = super().combined(now)
        estimates = self.read([mode.updated for mode in now.modes], len(now.modes))
        return mean, sum(w * p for w, (_, p) in zip(now.mode_probabilities, estimates))


class CombinedWithPredictedProbabilities:
    """c_j in place of mu_j."""

    def combined(self, now):
        estimates = self.read([mode.updated for mode in now.modes], len(now.modes))
        return mixture(now.predicted_mode_probabilities, estimates, self.angles[-1])


class StatesMixedUnconverted:
    """One list of states for all modes: the mixing does not know what they mean."""

    def mixed(self, mode):
        return mixture(mode.mixing_probabilities, self.estimates, 0 * self.angles[mode.index])


class StateConversionJacobianOmitted:
    """The means are converted to be mixed, and the covariances come along as they are."""

    def mixed(self, mode):
        estimates = []
        for i, (mean, covariance) in enumerate(self.estimates):
            function, added = self.reads.get((i, mode.index), (None, 0))
            mean = mean if function is None else function.of(mean)
            estimates.append((mean, covariance + added))
        return mixture(mode.mixing_probabilities, estimates, self.angles[mode.index])


class StateConversionCovarianceNotAdded:
    """What a mode does not know is padded with zeros."""

    def converted(self, function, added, mean, covariance):
        return super().converted(function, 0 * added, mean, covariance)


MISTAKES = {
    "states-mixed-unconverted": StatesMixedUnconverted,
    "state-conversion-jacobian-omitted": StateConversionJacobianOmitted,
    "state-conversion-covariance-not-added": StateConversionCovarianceNotAdded,
    "transition-transposed": TransitionTransposed,
    "transition-transposed-in-mixing": TransitionTransposedInMixing,
    "chain-by-an-euler-step": ChainByAnEulerStep,
    "sojourn-times-as-rates": SojournTimesAsRates,
    "mixing-with-mode-probabilities-alone": MixingWithModeProbabilitiesAlone,
    "common-start-mixed-by-the-chain": CommonStartMixedByTheChain,
    "mixing-skipped": MixingSkipped,
    "mixed-spread-omitted": MixedSpreadOmitted,
    "covariances-not-mixed": CovariancesNotMixed,
    "process-noise-omitted": ProcessNoiseOmitted,
    "process-noise-doubled": ProcessNoiseDoubled,
    "points-not-drawn-afresh": PointsNotDrawnAfresh,
    "points-from-rows-of-the-root": PointsFromRowsOfTheRoot,
    "cubature-5-weight-13": Cubature5Weight13,
    "converted-covariance-not-rotated": ConvertedCovarianceNotRotated,
    "converted-covariance-cross-term-of-other-sign": ConvertedCovarianceCrossTermOfOtherSign,
    "measurement-noise-doubled": MeasurementNoiseDoubled,
    "measurement-noise-omitted": MeasurementNoiseOmitted,
    "innovation-not-wrapped": InnovationNotWrapped,
    "measurement-of-the-mean": MeasurementOfTheMean,
    "gain-of-mixed-covariance": GainOfMixedCovariance,
    "covariance-not-updated": CovarianceNotUpdated,
    "determinant-omitted": DeterminantOmitted,
    "exponent-without-half": ExponentWithoutHalf,
    "likelihood-of-updated-residual": LikelihoodOfUpdatedResidual,
    "updated-with-old-probabilities": UpdatedWithOldProbabilities,
    "prior-omitted": PriorOmitted,
    "probabilities-not-advanced": ProbabilitiesNotAdvanced,
    "last-likelihood-used-again": LastLikelihoodUsedAgain,
    "combined-spread-omitted": CombinedSpreadOmitted,
    "combined-with-predicted-probabilities": CombinedWithPredictedProbabilities,
}
