// Between a problem of Immaculate and the filter of imm.hpp: the only file that knows both.
//
// To check a filter of your own, keep the shape of this file and change the lines marked CHANGE HERE. For problems of format 1 a
// constructor that reads matrices and a `step(z)` are all; what is below them is for format 2: formulas, sensors, steps that differ.
#pragma once

#include "formulas.hpp"
#include "imm.hpp"

#include <immaculate.hpp>

using immaculate::Part;

// CHANGE HERE: your filter's name, and which filters there are
inline immaculate::Program program() {
    return {"C++ example", {"kalman", "extended", "cubature-3", "converted"}, {"immaculate-problem/1", "immaculate-problem/2"}};
}

class Adapter {
public:
    // CHANGE HERE: your filter from a problem
    explicit Adapter(const Part &problem) : problem_(problem), n_(problem["state"].parts().size()) {
        check_what_is_here();
        const std::vector<Part> modes = problem["initial"]["modes"].sized(problem["modes"].parts().size(), "estimates");
        imm_.probabilities = problem["initial"]["mode_probabilities"].vector<VectorXd>(modes.size());
        for (const Part &mode : modes)
            imm_.estimates.push_back({mode["mean"].vector<VectorXd>(n_), mode["covariance"].matrix<MatrixXd>(n_, n_)});
        for (const Part &entry : problem["state"].parts()) {
            names_.state.push_back(name_of(entry));
            imm_.angles.is_angle.push_back(is_angle(entry));
        }
        imm_.has_points = immaculate::kind_of(problem) == "cubature-3";
        const std::string first_step = problem["conventions"]["first_step"].text();
        imm_.mixes = first_step == "mixed";
        imm_.predicts = first_step != "predicted";
    }

    // CHANGE HERE: one step of your filter
    immaculate::Shown step(const immaculate::Measured &z, const Part &entry) {
        give_models(z, entry);
        if (!z) return shown(imm_.step(std::nullopt), false);
        std::vector<double> there;
        for (const double value : *z)
            if (!std::isnan(value)) there.push_back(value);
        return shown(imm_.step(VectorXd(Eigen::Map<VectorXd>(there.data(), there.size()))), true);
    }

private:
    void check_what_is_here() const {
        for (const Part &mode : problem_["modes"].parts()) {
            if (mode.has("filter")) throw immaculate::Skipped("there is one filter for all modes here");
            if (mode["Q"].raw().is_object()) throw immaculate::Skipped("there are no named noises here; formulas are");
        }
    }

    // CHANGE HERE: what your filter can show of a step
    immaculate::Shown shown(const Step &step, bool is_detected) const {
        immaculate::Shown result;
        const auto estimate = [](const Estimate &of, const std::string &name, auto &&set) {
            set(name + ".mean", of.mean);
            set(name + ".covariance", of.covariance);
        };
        const auto whole = [&](const std::string &name, const auto &value) { result.set(name, value); };
        whole("predicted_mode_probabilities", step.predicted_mode_probabilities);
        whole("mode_probabilities", step.mode_probabilities);
        estimate(step.combined_prediction, "combined_prediction", whole);
        estimate(step.combined, "combined", whole);
        if (step.converted) {
            whole("converted_measurement", step.converted->mean);
            whole("converted_covariance", step.converted->covariance);
        }
        const bool is_extended = immaculate::kind_of(problem_) == "extended";
        for (std::size_t j = 0; j < step.modes.size(); ++j) {
            const ModeStep &mode = step.modes[j];
            const auto of_mode = [&](const std::string &name, const auto &value) { result.set(name, j, value); };
            of_mode("mixing_probabilities", mode.mixing_probabilities);
            estimate(mode.mixed, "mixed", of_mode);
            estimate(mode.predicted, "predicted", of_mode);
            estimate(mode.updated, "updated", of_mode);
            if (is_extended) of_mode("motion_jacobian", mode.motion_jacobian);
            if (!is_detected) continue;
            of_mode("predicted_measurement", mode.predicted_measurement);
            of_mode("innovation", mode.innovation);
            if (is_extended) of_mode("measurement_jacobian", mode.measurement_jacobian);
            of_mode("innovation_covariance", mode.innovation_covariance);
            of_mode("cross_covariance", mode.cross_covariance);
            of_mode("gain", mode.gain);
            of_mode("log_likelihood", mode.log_likelihood);
            of_mode("nis", mode.nis);
        }
        return result;
    }

    // The models of a step; in format 1 they are the same in all steps.
    void give_models(const immaculate::Measured &z, const Part &entry) {
        const std::vector<Part> modes = problem_["modes"].parts();
        imm_.transition = (entry.has("transition") ? entry : problem_)["transition"].matrix<MatrixXd>(modes.size(), modes.size());
        imm_.motions.clear();
        for (std::size_t j = 0; j < modes.size(); ++j) {
            const Names names = names_at(entry, &modes[j]);
            Motion motion;
            if (entry.has("F") || modes[j].has("F"))
                motion.f = linear((entry.has("F") ? entry["F"].sized(modes.size())[j] : modes[j]["F"]).matrix<MatrixXd>(n_, n_));
            else if (modes[j].has("f"))
                motion.f = formulas(names, texts(modes[j]["f"].sized(n_)));
            else
                motion.f = named(modes[j]["motion"], names);
            motion.Q = noise(entry.has("Q") ? entry["Q"].sized(modes.size())[j] : modes[j]["Q"], names);
            imm_.motions.push_back(motion);
        }
        imm_.sensor = sensor_at(entry);
        if (z) keep_what_is_there(imm_.sensor, *z);
    }

    Sensor sensor_at(const Part &entry) const {
        Part source = problem_;
        if (entry.has("sensor"))
            for (const Part &other : problem_["sensors"].parts())
                if (other["name"].text() == entry["sensor"].text()) source = other;
        const Part measurement = source["measurement"], R = (entry.has("R") ? entry : source)["R"];
        const std::size_t m = R.parts().size();
        Sensor sensor;
        sensor.R = R.matrix<MatrixXd>(m, m);
        const std::string kind = measurement["kind"].text();
        if (kind == "linear") {
            sensor.h = linear((entry.has("H") ? entry : measurement)["H"].matrix<MatrixXd>(m, n_));
        } else if (kind == "formulas") {
            for (const Part &component : measurement["z"].sized(m)) sensor.angles.is_angle.push_back(is_angle(component));
            sensor.h = formulas(names_at(entry, nullptr), texts(measurement["h"].sized(m)));
        } else if (kind != "range-bearing") {
            throw immaculate::Skipped("there are no named measurements here; formulas are");
        } else if (problem_["filter"]["kind"].text() == "converted") {
            sensor.conversion = conversion_of(problem_["filter"]["conversion"].text(), measurement, sensor.R);
            MatrixXd H = MatrixXd::Zero(2, n_);
            for (int axis = 0; axis < 2; ++axis) H(axis, position(measurement)[axis]) = 1;
            sensor.h = linear(H);
        } else {
            for (const Part &component : measurement["components"].sized(m))
                sensor.angles.is_angle.push_back(component.text() == "bearing");
            sensor.h = range_bearing(measurement, sensor.angles.is_angle);
        }
        return sensor;
    }

    // Without the rows of entries that are missing
    static void keep_what_is_there(Sensor &sensor, const std::vector<double> &z) {
        std::vector<int> rows;
        for (std::size_t row = 0; row < z.size(); ++row)
            if (!std::isnan(z[row])) rows.push_back(static_cast<int>(row));
        if (rows.size() == z.size()) return;
        const Model all = sensor.h;
        sensor.h.of = [all, rows](const VectorXd &x) { return VectorXd(all.of(x)(rows)); };
        sensor.h.slopes = [all, rows](const VectorXd &x) { return MatrixXd(all.slopes(x)(rows, Eigen::all)); };
        sensor.R = MatrixXd(sensor.R(rows, rows));
        std::vector<bool> is_angle;
        if (!sensor.angles.is_angle.empty())
            for (const int row : rows) is_angle.push_back(sensor.angles.is_angle[row]);
        sensor.angles.is_angle = is_angle;
    }

    static Model linear(const MatrixXd &matrix) {
        return {[matrix](const VectorXd &x) { return VectorXd(matrix * x); }, [matrix](const VectorXd &) { return matrix; }};
    }

    static Model formulas(const Names &names, const std::vector<std::string> &texts) {
        const auto of = [names, texts](const VectorXd &x) {
            VectorXd values(texts.size());
            for (std::size_t row = 0; row < texts.size(); ++row) values(row) = names.of(texts[row], x).value;
            return values;
        };
        const auto slopes = [names, texts](const VectorXd &x) {
            MatrixXd rows(texts.size(), x.size());
            for (std::size_t row = 0; row < texts.size(); ++row) rows.row(row) = names.of(texts[row], x).slopes;
            return rows;
        };
        return {of, slopes};
    }

    // The named motions that are here; `others` says what becomes of what they do not move.
    static Model named(const Part &motion, const Names &names) {
        std::map<std::string, std::string> moved;
        if (motion["model"].text() == "constant-velocity") {
            moved = {{"x", "x + T*vx"}, {"vx", "vx"}, {"y", "y + T*vy"}, {"vy", "vy"}, {"z", "z + T*vz"}, {"vz", "vz"}};
        } else if (motion["model"].text() == "coordinated-turn-unknown-rate") {
            moved = {{"x", "x + T*(c1((w*T)^2)*vx - w*T*c2((w*T)^2)*vy)"}, {"vx", "cos(w*T)*vx - sin(w*T)*vy"},
                     {"y", "y + T*(w*T*c2((w*T)^2)*vx + c1((w*T)^2)*vy)"}, {"vy", "sin(w*T)*vx + cos(w*T)*vy"},
                     {"w", "w"}};
        } else {
            throw immaculate::Skipped("there is no motion `" + motion["model"].text() + "` here; formulas are");
        }
        const bool are_zero = motion.has("others") && motion["others"].text() == "zero";
        std::vector<std::string> texts;
        for (const std::string &name : names.state) texts.push_back(moved.count(name) > 0 ? moved[name] : are_zero ? "0" : name);
        return formulas(names, texts);
    }

    Model range_bearing(const Part &measurement, const std::vector<bool> &is_bearing) const {
        const Eigen::Vector2i at = position(measurement);
        const Eigen::Vector2d from = measurement["sensor"].vector<Eigen::Vector2d>(2);
        const auto of = [=](const VectorXd &x) {
            const double dx = x(at[0]) - from[0], dy = x(at[1]) - from[1];
            VectorXd z(is_bearing.size());
            for (int row = 0; row < z.size(); ++row) z(row) = is_bearing[row] ? std::atan2(dy, dx) : std::hypot(dx, dy);
            return z;
        };
        const auto slopes = [=](const VectorXd &x) {
            const double dx = x(at[0]) - from[0], dy = x(at[1]) - from[1], range = std::hypot(dx, dy), square = dx * dx + dy * dy;
            MatrixXd H = MatrixXd::Zero(is_bearing.size(), x.size());
            for (int row = 0; row < H.rows(); ++row) {
                H(row, at[0]) = is_bearing[row] ? -dy / square : dx / range;
                H(row, at[1]) = is_bearing[row] ? dx / square : dy / range;
            }
            return H;
        };
        return {of, slopes};
    }

    static Conversion conversion_of(const std::string &name, const Part &measurement, const MatrixXd &R) {
        Conversion conversion;
        conversion.name = name;
        conversion.range = measurement["components"].sized(2)[0].text() == "range" ? 0 : 1;
        conversion.bearing = 1 - conversion.range;
        conversion.sensor = measurement["sensor"].vector<Eigen::Vector2d>(2);
        conversion.range_variance = R(conversion.range, conversion.range);
        conversion.bearing_variance = R(conversion.bearing, conversion.bearing);
        return conversion;
    }

    Eigen::Vector2i position(const Part &measurement) const { return measurement["position"].vector<Eigen::Vector2i>(2); }

    // What formulas know in a step: the problem's names, and those of a mode if one is given
    Names names_at(const Part &entry, const Part *mode) const {
        Names names = names_;
        for (const Part *source : {&problem_, mode}) {
            if (source == nullptr) continue;
            if (source->has("parameters"))
                for (const auto &[name, value] : (*source)["parameters"].raw().items()) names.numbers[name] = value;
            if (source == &problem_ && entry.has("T")) names.numbers["T"] = entry["T"].number();
            if (source->has("let"))
                for (const Part &definition : (*source)["let"].parts())
                    names.definitions.emplace_back(definition.sized(2)[0].text(), definition.sized(2)[1].text());
        }
        return names;
    }

    // Q, which may have formulas; they do not know the state
    MatrixXd noise(const Part &rows, const Names &names) const {
        MatrixXd Q(n_, n_);
        for (std::size_t i = 0; i < n_; ++i) {
            const std::vector<Part> entries = rows.sized(n_, "rows")[i].sized(n_);
            for (std::size_t k = 0; k < n_; ++k)
                Q(i, k) = entries[k].raw().is_string() ? names.of(entries[k].text(), VectorXd(0)).value : entries[k].number();
        }
        return Q;
    }

    static std::vector<std::string> texts(const std::vector<Part> &parts) {
        std::vector<std::string> result;
        for (const Part &part : parts) result.push_back(part.text());
        return result;
    }

    // An entry of the state or of z is a name, [name, unit], or [name, unit, "angle"].
    static std::string name_of(const Part &entry) { return entry.raw().is_string() ? entry.text() : entry.parts().at(0).text(); }
    static bool is_angle(const Part &entry) { return entry.raw().is_array() && entry.raw().size() > 2 && entry.raw()[2] == "angle"; }

    Part problem_;
    std::size_t n_;
    Names names_;
    Imm imm_;
};
