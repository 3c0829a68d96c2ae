// An IMM filter in C++17 with Eigen: Kalman filters, of converted measurements too, or filters with the points of the third-degree
// cubature rule.
//
// It knows nothing of the protocol; that is in main.cpp.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Estimate {
    VectorXd mean;
    MatrixXd covariance;
};

// What the sensor sees: H x, or ranges and bearings.
struct Measurement {
    std::optional<MatrixXd> matrix;
    std::vector<bool> is_bearing;  // one an entry of z, where there is no matrix
    int position[2] = {0, 0};
    double sensor[2] = {0, 0};

    VectorXd of(const VectorXd &state) const {
        if (matrix) return *matrix * state;
        const double dx = state(position[0]) - sensor[0], dy = state(position[1]) - sensor[1];
        VectorXd z(is_bearing.size());
        for (int row = 0; row < z.size(); ++row) z(row) = is_bearing[row] ? std::atan2(dy, dx) : std::hypot(dx, dy);
        return z;
    }

    // a - b, with its bearings wrapped to (-pi, pi]
    VectorXd difference(const VectorXd &a, const VectorXd &b) const {
        VectorXd d = a - b;
        const double turn = 2 * M_PI;
        for (std::size_t row = 0; row < is_bearing.size(); ++row)
            if (is_bearing[row]) d(row) -= turn * std::ceil((d(row) - M_PI) / turn);
        return d;
    }
};

// How a range and a bearing become a position with a covariance.
struct Conversion {
    std::string name;
    int range = 0, bearing = 1;  // where they stand in z
    Eigen::Vector2d sensor;
    double range_variance = 0, bearing_variance = 0;

    Estimate of(const VectorXd &z) const {
        const double r = z(range), w = std::exp(-bearing_variance / 2), w2 = w * w, w4 = w2 * w2;
        const double square = r * r, once = square + range_variance, twice = once + range_variance;
        // The standard one: factor of the position, variances along and across the line of sight.
        double factor = 1, along = range_variance, across = square * bearing_variance;
        if (name != "standard") {
            along = (1 + w4) / 2 * once;
            across = (1 - w4) / 2 * once;
        }
        if (name == "additive") {
            factor = 1 - (w2 - w);
            along = (1 + w4 * w4) / 2 * twice - w2 * along;
            across = (1 - w4 * w4) / 2 * twice - w2 * across;
        } else if (name == "multiplicative") {
            factor = 1 / w;
            along += (1 / w2 - 2) * square;
        } else if (name == "modified-unbiased") {
            factor = w;
            along -= w2 * square;
        }
        const Eigen::Matrix2d axes = Eigen::Rotation2Dd(z(bearing)).toRotationMatrix();
        return {sensor + factor * r * axes.col(0), axes * Eigen::Vector2d(along, across).asDiagonal() * axes.transpose()};
    }
};

// What one mode computes in one step.
struct ModeStep {
    VectorXd mixing_probabilities;
    Estimate mixed, predicted, updated;
    VectorXd predicted_measurement, innovation;
    MatrixXd innovation_covariance, cross_covariance, gain;
    double log_likelihood = 0;
};

// What all modes compute in one step.
struct Step {
    VectorXd predicted_mode_probabilities, mode_probabilities;
    std::vector<ModeStep> modes;
    Estimate combined_prediction, combined;
    std::optional<Estimate> converted;  // the measured position
};

class Imm {
public:
    std::vector<MatrixXd> F, Q;     // one a mode
    MatrixXd R;                     // of converted measurements: of this step
    Measurement measurement;
    std::optional<Conversion> conversion;
    bool has_points = false;        // the third-degree rule, or the Kalman filter
    MatrixXd transition;            // transition(i, j): from i to j
    VectorXd probabilities;
    std::vector<Estimate> estimates;

    // One step with a measurement, or without a detection.
    Step step(const std::optional<VectorXd> &z) {
        const int r = static_cast<int>(F.size());
        Step now;
        now.predicted_mode_probabilities = transition.transpose() * probabilities;
        now.modes.resize(r);
        std::vector<Estimate> predicted, updated;
        for (int j = 0; j < r; ++j) {
            ModeStep &mode = now.modes[j];
            const double c = now.predicted_mode_probabilities(j);
            // A mode that cannot be reached keeps its own estimate.
            mode.mixing_probabilities = VectorXd::Unit(r, j);
            if (c > 0) mode.mixing_probabilities = transition.col(j).cwiseProduct(probabilities) / c;
            mode.mixed = mixture(mode.mixing_probabilities, estimates);
            mode.predicted = predict(j, mode.mixed);
            predicted.push_back(mode.predicted);
        }
        now.combined_prediction = mixture(now.predicted_mode_probabilities, predicted);
        if (z && conversion) now.converted = conversion->of(*z);
        if (now.converted) R = now.converted->covariance;
        for (ModeStep &mode : now.modes) {
            mode.updated = mode.predicted;
            if (z) update(mode, now.converted ? now.converted->mean : *z);
            updated.push_back(mode.updated);
        }
        now.mode_probabilities = z ? weigh(now) : now.predicted_mode_probabilities;
        now.combined = mixture(now.mode_probabilities, updated);
        estimates = updated;
        probabilities = now.mode_probabilities;
        return now;
    }

private:
    Estimate predict(int j, const Estimate &mixed) const {
        if (!has_points) return {F[j] * mixed.mean, F[j] * mixed.covariance * F[j].transpose() + Q[j]};
        const MatrixXd points = F[j] * points_of(mixed);
        const VectorXd mean = points.rowwise().mean();
        const MatrixXd deviations = points.colwise() - mean;
        return {mean, deviations * deviations.transpose() / points.cols() + Q[j]};
    }

    void update(ModeStep &mode, const VectorXd &z) const {
        const auto &[mean, covariance] = mode.predicted;
        if (has_points) {
            measure_points(mode);
        } else {
            const MatrixXd &H = *measurement.matrix;
            mode.predicted_measurement = H * mean;
            mode.innovation_covariance = H * covariance * H.transpose() + R;
            mode.cross_covariance = covariance * H.transpose();
        }
        mode.innovation = measurement.difference(z, mode.predicted_measurement);
        const Eigen::LLT<MatrixXd> S(mode.innovation_covariance);
        if (S.info() != Eigen::Success) throw std::runtime_error("innovation covariance is not positive definite");
        mode.gain = S.solve(mode.cross_covariance.transpose()).transpose();
        mode.updated.mean = mean + mode.gain * mode.innovation;
        mode.updated.covariance = covariance - mode.gain * mode.innovation_covariance * mode.gain.transpose();
        const MatrixXd root = S.matrixL();
        const double log_determinant = 2 * root.diagonal().array().log().sum();
        mode.log_likelihood =
            -(mode.innovation.dot(S.solve(mode.innovation)) + log_determinant + z.size() * std::log(2 * M_PI)) / 2;
    }

    void measure_points(ModeStep &mode) const {
        const MatrixXd points = points_of(mode.predicted);
        const VectorXd centre = measurement.of(mode.predicted.mean);
        MatrixXd values(R.rows(), points.cols());
        VectorXd sum = VectorXd::Zero(R.rows());
        for (int s = 0; s < points.cols(); ++s) {
            values.col(s) = measurement.of(points.col(s));
            sum += measurement.difference(values.col(s), centre);
        }
        mode.predicted_measurement = centre + sum / points.cols();
        for (int s = 0; s < points.cols(); ++s)
            values.col(s) = measurement.difference(values.col(s), mode.predicted_measurement);
        const MatrixXd deviations = points.colwise() - mode.predicted.mean;
        mode.innovation_covariance = values * values.transpose() / points.cols() + R;
        mode.cross_covariance = deviations * values.transpose() / points.cols();
    }

    // Bayes' rule, with likelihoods relative to the greatest
    static VectorXd weigh(const Step &now) {
        VectorXd weights = now.predicted_mode_probabilities;
        double greatest = -INFINITY;
        for (int j = 0; j < weights.size(); ++j)
            if (weights(j) > 0) greatest = std::max(greatest, now.modes[j].log_likelihood);
        for (int j = 0; j < weights.size(); ++j)
            if (weights(j) > 0) weights(j) *= std::exp(now.modes[j].log_likelihood - greatest);
        return weights / weights.sum();
    }

    // The points of the third-degree rule, one a column
    static MatrixXd points_of(const Estimate &estimate) {
        const Eigen::LLT<MatrixXd> factor(estimate.covariance);
        if (factor.info() != Eigen::Success) throw std::runtime_error("covariance is not positive definite");
        const int n = static_cast<int>(estimate.mean.size());
        const MatrixXd root = std::sqrt(n) * MatrixXd(factor.matrixL());
        MatrixXd points(n, 2 * n);
        points << root, -root;
        return points.colwise() + estimate.mean;
    }

    static Estimate mixture(const VectorXd &weights, const std::vector<Estimate> &parts) {
        const auto n = parts[0].mean.size();
        Estimate whole{VectorXd::Zero(n), MatrixXd::Zero(n, n)};
        for (std::size_t i = 0; i < parts.size(); ++i) whole.mean += weights(i) * parts[i].mean;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const VectorXd spread = parts[i].mean - whole.mean;
            whole.covariance += weights(i) * (parts[i].covariance + spread * spread.transpose());
        }
        return whole;
    }
};
