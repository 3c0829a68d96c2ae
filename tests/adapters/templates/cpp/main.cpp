// My filter under test: immaculate check -- build/my_filter
//
// MyFilter is a correct textbook interacting multiple model filter with Kalman filters. Replace it with your own: Immaculate sees only the
// parts marked CHANGE HERE. immaculate.hpp can stay as it is.

#include "immaculate.hpp"

#include <Eigen/Dense>

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Estimate {
    VectorXd mean;
    MatrixXd covariance;
};

// Mean and covariance of a mixture, the spread of its means included
Estimate mixture(const VectorXd &weights, const std::vector<Estimate> &estimates) {
    const Eigen::Index n = estimates[0].mean.size();
    Estimate result{VectorXd::Zero(n), MatrixXd::Zero(n, n)};
    for (std::size_t i = 0; i < estimates.size(); ++i) result.mean += weights[i] * estimates[i].mean;
    for (std::size_t i = 0; i < estimates.size(); ++i) {
        const VectorXd apart = estimates[i].mean - result.mean;
        result.covariance += weights[i] * (estimates[i].covariance + apart * apart.transpose());
    }
    return result;
}

class MyFilter {
public:
    // CHANGE HERE: your filter from a problem. A single filter throws immaculate::Skipped("there is one mode only") for several modes.
    explicit MyFilter(const immaculate::Part &problem) {
        const std::vector<immaculate::Part> modes = problem["modes"].parts(), initial = problem["initial"]["modes"].parts();
        const std::size_t n = problem["state"].parts().size(), m = problem["R"].parts().size(), r = modes.size();
        for (std::size_t j = 0; j < r; ++j) {
            F.push_back(modes[j]["F"].matrix<MatrixXd>(n, n));
            Q.push_back(modes[j]["Q"].matrix<MatrixXd>(n, n));
            estimates.push_back({initial[j]["mean"].vector<VectorXd>(n), initial[j]["covariance"].matrix<MatrixXd>(n, n)});
        }
        H = problem["measurement"]["H"].matrix<MatrixXd>(m, n);
        R = problem["R"].matrix<MatrixXd>(m, m);
        transition = problem["transition"].matrix<MatrixXd>(r, r);  // transition(i, j): from mode i to mode j
        probabilities = problem["initial"]["mode_probabilities"].vector<VectorXd>(r);
    }

    // CHANGE HERE: one step of your filter; z is empty without a detection. Its values go into `shown`, from combined.mean alone to
    // everything: the more it shows, the closer the verdict gets to the wrong line.
    immaculate::Shown step(const immaculate::Measured &z) {
        immaculate::Shown shown;
        const Eigen::Index r = transition.rows();
        const VectorXd c = transition.transpose() * probabilities;
        shown.set("predicted_mode_probabilities", c);

        std::vector<Estimate> now;
        for (Eigen::Index j = 0; j < r; ++j) {  // mix
            VectorXd weights = VectorXd::Unit(r, j);  // a mode that no mode leads to keeps its own estimate
            if (c[j] > 0) weights = transition.col(j).cwiseProduct(probabilities) / c[j];
            now.push_back(mixture(weights, estimates));
            shown.set("mixing_probabilities", j, weights);
            shown.set("mixed.mean", j, now[j].mean).set("mixed.covariance", j, now[j].covariance);
        }

        for (Eigen::Index j = 0; j < r; ++j) {  // predict
            now[j] = {F[j] * now[j].mean, F[j] * now[j].covariance * F[j].transpose() + Q[j]};
            shown.set("predicted.mean", j, now[j].mean).set("predicted.covariance", j, now[j].covariance);
        }
        const Estimate prediction = mixture(c, now);
        shown.set("combined_prediction.mean", prediction.mean).set("combined_prediction.covariance", prediction.covariance);

        VectorXd log_likelihoods = VectorXd::Zero(r);
        for (Eigen::Index j = 0; j < r; ++j) {  // update
            if (z) {
                const VectorXd predicted = H * now[j].mean, innovation = VectorXd::Map(z->data(), z->size()) - predicted;
                const MatrixXd cross = now[j].covariance * H.transpose(), S = H * cross + R;
                const Eigen::LDLT<MatrixXd> factor(S);
                const MatrixXd gain = factor.solve(cross.transpose()).transpose();
                const double log_determinant = (2 * EIGEN_PI * factor.vectorD().array()).log().sum();
                const double nis = innovation.dot(factor.solve(innovation));
                log_likelihoods[j] = -(nis + log_determinant) / 2;
                shown.set("predicted_measurement", j, predicted).set("innovation", j, innovation);
                shown.set("innovation_covariance", j, S).set("cross_covariance", j, cross).set("gain", j, gain);
                shown.set("log_likelihood", j, log_likelihoods[j]).set("nis", j, nis);
                now[j].mean += gain * innovation;
                const MatrixXd P = now[j].covariance - gain * S * gain.transpose();
                now[j].covariance = (P + P.transpose()) / 2;  // what is not symmetric is rounding, and would grow
            }
            shown.set("updated.mean", j, now[j].mean).set("updated.covariance", j, now[j].covariance);
        }

        estimates = now;
        probabilities = c;
        if (z) {  // weigh: in logarithms, for likelihoods may all be zero as doubles
            double greatest = -std::numeric_limits<double>::infinity();
            for (Eigen::Index j = 0; j < r; ++j)
                if (c[j] > 0) greatest = std::max(greatest, log_likelihoods[j]);
            for (Eigen::Index j = 0; j < r; ++j)
                if (c[j] > 0) probabilities[j] = c[j] * std::exp(log_likelihoods[j] - greatest);
            probabilities /= probabilities.sum();
        }
        const Estimate combined = mixture(probabilities, now);
        shown.set("mode_probabilities", probabilities);
        shown.set("combined.mean", combined.mean).set("combined.covariance", combined.covariance);
        return shown;
    }

private:
    std::vector<MatrixXd> F, Q;
    MatrixXd H, R, transition;
    std::vector<Estimate> estimates;
    VectorXd probabilities;
};

int main() {
    // CHANGE HERE: your filter's name and its kinds of filter; `immaculate cases list` names the kinds
    return immaculate::speak<MyFilter>({"my filter", {"kalman"}});
}
