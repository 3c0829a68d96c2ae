// The adapter through which `immaculate check` speaks with the filter of imm.hpp.
//
//     g++ -std=c++17 -O2 -I /usr/include/eigen3 -o imm tests/adapters/cpp/main.cpp
//     immaculate check -- ./imm
//
// To check a filter of your own, keep this file and change the lines marked CHANGE HERE.

#include "imm.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

using nlohmann::json;

// A list of rows; the matrix type itself goes by columns.
static MatrixXd matrix(const json &rows) {
    MatrixXd result(rows.size(), rows.at(0).size());
    for (int i = 0; i < result.rows(); ++i)
        for (int k = 0; k < result.cols(); ++k) result(i, k) = rows.at(i).at(k);
    return result;
}

static VectorXd vector(const json &list) {
    VectorXd result(list.size());
    for (int i = 0; i < result.size(); ++i) result(i) = list.at(i);
    return result;
}

static json list(const VectorXd &values) { return std::vector<double>(values.begin(), values.end()); }

static json rows(const MatrixXd &values) {
    json result = json::array();
    for (int i = 0; i < values.rows(); ++i) result.push_back(list(values.row(i)));
    return result;
}

static json object(const Estimate &estimate) {
    return {{"mean", list(estimate.mean)}, {"covariance", rows(estimate.covariance)}};
}

static Conversion conversion_of(const json &problem) {
    Conversion conversion;
    const json &measurement = problem.at("measurement"), &R = problem.at("R");
    conversion.name = problem.at("filter").at("conversion");
    conversion.range = measurement.at("components").at(0) == "range" ? 0 : 1;
    conversion.bearing = 1 - conversion.range;
    conversion.sensor = vector(measurement.at("sensor"));
    conversion.range_variance = R.at(conversion.range).at(conversion.range);
    conversion.bearing_variance = R.at(conversion.bearing).at(conversion.bearing);
    return conversion;
}

// CHANGE HERE: your filter from a problem
static Imm filter_of(const json &problem) {
    Imm imm;
    for (const json &mode : problem.at("modes")) {
        imm.F.push_back(matrix(mode.at("F")));
        imm.Q.push_back(matrix(mode.at("Q")));
    }
    imm.R = matrix(problem.at("R"));
    const json &measurement = problem.at("measurement");
    if (measurement.at("kind") == "linear") {
        imm.measurement.matrix = matrix(measurement.at("H"));
    } else if (problem.at("filter").at("kind") == "converted") {
        imm.conversion = conversion_of(problem);
        MatrixXd H = MatrixXd::Zero(2, problem.at("state").size());
        for (int axis = 0; axis < 2; ++axis) H(axis, measurement.at("position").at(axis).get<int>()) = 1;
        imm.measurement.matrix = H;
    } else {
        for (const json &component : measurement.at("components")) imm.measurement.is_bearing.push_back(component == "bearing");
        for (int axis = 0; axis < 2; ++axis) {
            imm.measurement.position[axis] = measurement.at("position").at(axis);
            imm.measurement.sensor[axis] = measurement.at("sensor").at(axis);
        }
    }
    imm.has_points = problem.at("filter").at("kind") == "cubature";
    imm.transition = matrix(problem.at("transition"));
    imm.probabilities = vector(problem.at("initial").at("mode_probabilities"));
    for (const json &mode : problem.at("initial").at("modes"))
        imm.estimates.push_back({vector(mode.at("mean")), matrix(mode.at("covariance"))});
    return imm;
}

// CHANGE HERE: what your filter can show of a step
static json shown(int number, const Step &step, bool is_detected) {
    json modes = json::array();
    for (const ModeStep &mode : step.modes) {
        json values = {{"mixing_probabilities", list(mode.mixing_probabilities)},
                       {"mixed", object(mode.mixed)},
                       {"predicted", object(mode.predicted)},
                       {"updated", object(mode.updated)}};
        if (is_detected) {
            values["predicted_measurement"] = list(mode.predicted_measurement);
            values["innovation"] = list(mode.innovation);
            values["innovation_covariance"] = rows(mode.innovation_covariance);
            values["cross_covariance"] = rows(mode.cross_covariance);
            values["gain"] = rows(mode.gain);
            values["log_likelihood"] = mode.log_likelihood;
        }
        modes.push_back(values);
    }
    json result = {{"step", number},
                   {"predicted_mode_probabilities", list(step.predicted_mode_probabilities)},
                   {"modes", modes},
                   {"combined_prediction", object(step.combined_prediction)},
                   {"mode_probabilities", list(step.mode_probabilities)},
                   {"combined", object(step.combined)}};
    if (step.converted) {
        result["converted_measurement"] = list(step.converted->mean);
        result["converted_covariance"] = rows(step.converted->covariance);
    }
    return result;
}

static json run(const json &problem) {
    json answer = {{"type", "answer"}, {"id", problem.at("id")}, {"steps", json::array()}};
    try {
        Imm imm = filter_of(problem);
        for (const json &entry : problem.at("measurements")) {
            std::optional<VectorXd> z;
            if (!entry.at("z").is_null()) z = vector(entry.at("z"));
            answer["steps"].push_back(shown(entry.at("step"), imm.step(z), z.has_value()));
        }
    } catch (const std::exception &error) {
        answer["error"] = error.what();
    }
    return answer;
}

int main() {
    for (std::string line; std::getline(std::cin, line);) {
        const json message = json::parse(line);
        if (message.at("type") == "stop") break;
        json reply;
        if (message.at("type") == "start") {
            const json &echo = message.at("echo");
            reply = {{"type", "ready"},
                     {"name", "C++ example"},                           // CHANGE HERE
                     {"kinds", {"kalman", "cubature-3", "converted"}},  // CHANGE HERE: which filters there are
                     {"validates", false},
                     {"echo", list(matrix(echo.at("matrix")) * vector(echo.at("vector")))}};
        } else {
            reply = run(message.at("problem"));
        }
        std::cout << reply.dump() << std::endl;  // with a flush
    }
}
