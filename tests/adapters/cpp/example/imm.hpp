// An IMM filter in C++17 with Eigen: Kalman filters, of converted measurements too, extended filters, or filters with the points of the
// third-degree cubature rule.
//
// It knows nothing of the protocol and of JSON; that is in adapter.hpp.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <functional>
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

// Which entries of a vector are angles: differences of these are wrapped to (-pi, pi].
struct Angles {
    std::vector<bool> is_angle;

    VectorXd difference(const VectorXd &a, const VectorXd &b) const {
        VectorXd d = a - b;
        const double turn = 2 * M_PI;
        for (std::size_t row = 0; row < is_angle.size(); ++row)
            if (is_angle[row]) d(row) -= turn * std::ceil((d(row) - M_PI) / turn);
        return d;
    }
};

// A function of the state, and its Jacobian.
struct Model {
    std::function<VectorXd(const VectorXd &)> of;
    std::function<MatrixXd(const VectorXd &)> slopes;
};

// What a mode does in a step.
struct Motion {
    Model f;
    MatrixXd Q;
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

// What is seen in a step.
struct Sensor {
    Model h;
    Angles angles;  // among the entries of z
    MatrixXd R;     // of converted measurements: of this step
    std::optional<Conversion> conversion;
};

// What one mode computes in one step.
struct ModeStep {
    VectorXd mixing_probabilities;
    Estimate mixed, predicted, updated;
    MatrixXd motion_jacobian, measurement_jacobian;  // of extended filters
    VectorXd predicted_measurement, innovation;
    MatrixXd innovation_covariance, cross_covariance, gain;
    double log_likelihood = 0, nis = 0;
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
    std::vector<Motion> motions;    // one a mode
    Sensor sensor;
    Angles angles;                  // among the entries of the state
    bool has_points = false;        // the third-degree rule, or Jacobians
    bool mixes = true;              // whether the next step does: the first may predict from the initial estimates themselves,
    bool predicts = true;           // or take these for its prediction
    MatrixXd transition;            // transition(i, j): from i to j
    VectorXd probabilities;
    std::vector<Estimate> estimates;

    // One step with a measurement, or without a detection. The models may be others before every step.
    Step step(const std::optional<VectorXd> &z) {
        const int r = static_cast<int>(motions.size());
        Step now;
        now.predicted_mode_probabilities = mixes ? VectorXd(transition.transpose() * probabilities) : probabilities;
        now.modes.resize(r);
        std::vector<Estimate> predicted, updated;
        for (int j = 0; j < r; ++j) {
            ModeStep &mode = now.modes[j];
            const double c = now.predicted_mode_probabilities(j);
            // A mode that cannot be reached keeps its own estimate.
            mode.mixing_probabilities = VectorXd::Unit(r, j);
            if (mixes && c > 0) mode.mixing_probabilities = transition.col(j).cwiseProduct(probabilities) / c;
            mode.mixed = mixture(mode.mixing_probabilities, estimates);
            mode.motion_jacobian = motions[j].f.slopes(mode.mixed.mean);
            mode.predicted = predicts ? predict(motions[j], mode) : mode.mixed;
            predicted.push_back(mode.predicted);
        }
        now.combined_prediction = mixture(now.predicted_mode_probabilities, predicted);
        if (z && sensor.conversion) now.converted = sensor.conversion->of(*z);
        if (now.converted) sensor.R = now.converted->covariance;
        for (ModeStep &mode : now.modes) {
            mode.updated = mode.predicted;
            if (z) update(mode, now.converted ? now.converted->mean : *z);
            updated.push_back(mode.updated);
        }
        now.mode_probabilities = z ? weigh(now) : now.predicted_mode_probabilities;
        now.combined = mixture(now.mode_probabilities, updated);
        estimates = updated;
        probabilities = now.mode_probabilities;
        mixes = predicts = true;
        return now;
    }

private:
    Estimate predict(const Motion &motion, const ModeStep &mode) const {
        const auto &[mean, covariance] = mode.mixed;
        const VectorXd centre = motion.f.of(mean);
        if (!has_points) {
            const MatrixXd &F = mode.motion_jacobian;
            return {centre, F * covariance * F.transpose() + motion.Q};
        }
        const Estimate moved = moments(points_of(mode.mixed), motion.f, centre, angles).first;
        return {moved.mean, moved.covariance + motion.Q};
    }

    void update(ModeStep &mode, const VectorXd &z) const {
        const auto &[mean, covariance] = mode.predicted;
        const VectorXd centre = sensor.h.of(mean);
        if (has_points) {
            const MatrixXd points = points_of(mode.predicted);
            const auto [seen, deviations] = moments(points, sensor.h, centre, sensor.angles);
            mode.predicted_measurement = seen.mean;
            mode.innovation_covariance = seen.covariance + sensor.R;
            mode.cross_covariance = (points.colwise() - mean) * deviations.transpose() / points.cols();
        } else {
            const MatrixXd H = sensor.h.slopes(mean);
            mode.measurement_jacobian = H;
            mode.predicted_measurement = centre;
            mode.innovation_covariance = H * covariance * H.transpose() + sensor.R;
            mode.cross_covariance = covariance * H.transpose();
        }
        mode.innovation = sensor.angles.difference(z, mode.predicted_measurement);
        const Eigen::LLT<MatrixXd> S(mode.innovation_covariance);
        if (S.info() != Eigen::Success) throw std::runtime_error("innovation covariance is not positive definite");
        mode.gain = S.solve(mode.cross_covariance.transpose()).transpose();
        mode.updated.mean = mean + mode.gain * mode.innovation;
        const MatrixXd rest = covariance - mode.gain * mode.innovation_covariance * mode.gain.transpose();
        mode.updated.covariance = (rest + rest.transpose()) / 2;  // what is not symmetric is rounding, and would grow from step to step
        const MatrixXd root = S.matrixL();
        const double log_determinant = 2 * root.diagonal().array().log().sum();
        mode.nis = mode.innovation.dot(S.solve(mode.innovation));
        mode.log_likelihood = -(mode.nis + log_determinant + z.size() * std::log(2 * M_PI)) / 2;
    }

    // Mean and covariance of a function of points, and the deviations of its values. Angles are averaged around a centre.
    static std::pair<Estimate, MatrixXd> moments(const MatrixXd &points, const Model &function, const VectorXd &centre,
                                                 const Angles &angles) {
        MatrixXd values(centre.size(), points.cols());
        VectorXd sum = VectorXd::Zero(centre.size());
        for (int s = 0; s < points.cols(); ++s) {
            values.col(s) = function.of(points.col(s));
            sum += angles.difference(values.col(s), centre);
        }
        const VectorXd mean = centre + sum / points.cols();
        for (int s = 0; s < points.cols(); ++s) values.col(s) = angles.difference(values.col(s), mean);
        return {{mean, values * values.transpose() / points.cols()}, values};
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

    // The points of the third-degree rule, one a column. An entry without variance has a row of zeros in the root, too.
    static MatrixXd points_of(const Estimate &estimate) {
        const int n = static_cast<int>(estimate.mean.size());
        std::vector<int> varying;
        for (int row = 0; row < n; ++row)
            if (!estimate.covariance.row(row).isZero(0)) varying.push_back(row);
        const Eigen::LLT<MatrixXd> factor(estimate.covariance(varying, varying));
        if (factor.info() != Eigen::Success) throw std::runtime_error("covariance is not positive definite");
        MatrixXd root = MatrixXd::Zero(n, n);
        root(varying, varying) = std::sqrt(n) * MatrixXd(factor.matrixL());
        MatrixXd points(n, 2 * n);
        points << root, -root;
        return points.colwise() + estimate.mean;
    }

    // Mean and covariance of a mixture; angles are averaged in the turn of the first mean's.
    Estimate mixture(const VectorXd &weights, const std::vector<Estimate> &parts) const {
        const VectorXd &first = parts[0].mean;
        const auto n = first.size();
        Estimate whole{VectorXd::Zero(n), MatrixXd::Zero(n, n)};
        for (std::size_t i = 0; i < parts.size(); ++i) whole.mean += weights(i) * in_turn(parts[i].mean, first);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const VectorXd spread = angles.difference(parts[i].mean, whole.mean);
            whole.covariance += weights(i) * (parts[i].covariance + spread * spread.transpose());
        }
        return whole;
    }

    // A state with its angles moved by full turns to those of another
    VectorXd in_turn(const VectorXd &state, const VectorXd &other) const {
        const VectorXd near = other + angles.difference(state, other);
        VectorXd result = state;
        for (std::size_t row = 0; row < angles.is_angle.size(); ++row)
            if (angles.is_angle[row]) result(row) = near(row);
        return result;
    }
};
