// Immaculate's checking protocol and certified cases for filters in C++17, in one header. JSON by nlohmann.
//
// Your filter is a class that is constructed from a problem and does one step at a time; nothing else is needed:
//
//     struct Adapter {
//         explicit Adapter(const immaculate::Part &problem);                     // throws Skipped for what it cannot do
//         immaculate::Shown step(const immaculate::Measured &z);                 // z is empty without a detection
//         immaculate::Shown step(const immaculate::Measured &z, const immaculate::Part &entry);  // or this, for format 2
//     };
//
// `speak<Adapter>(program)` is then the whole `main` of a program for `immaculate check -- PROGRAM`, and `judge<Adapter>(program, one)`
// the whole of a unit test of one certified case; `cases(folder, program)` reads the files that `immaculate cases copy FOLDER` writes.
// spec/formats.md defines the values. An exception of the filter becomes the protocol's `error`, with the step and the message.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace immaculate {

using nlohmann::json;

// The protocol of this header. Any other is refused with a message.
inline constexpr const char *PROTOCOL = "immaculate-check/1";

// An error larger than this multiple of the rounding noise cannot be rounding: LIMIT of `immaculate check`.
inline constexpr double LIMIT = 100;

// The program under test, as in the `ready` message.
struct Program {
    std::string name;
    std::vector<std::string> kinds;                            // which filters there are
    std::vector<std::string> formats{"immaculate-problem/1"};  // which problems it reads
    std::map<std::string, std::string> conventions{};          // those that differ from the cases'
    std::string precision = "double";                          // or "single"
    bool validates = false;                                    // whether it rejects what must be rejected
};

// Thrown if a problem needs something that the filter does not have.
struct Skipped : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Thrown for a problem that must be rejected, with its class.
struct Rejected : std::runtime_error {
    Rejected(std::string of_class, const std::string &reason) : std::runtime_error(reason), reason_class(std::move(of_class)) {}
    std::string reason_class;
};

// ---------------------------------------------------------------------------------------------------------- reading a problem

// A part of a problem, which names its place in every error. It lives no longer than the problem.
class Part {
public:
    explicit Part(const json &data, std::string place = "problem") : data_(&data), place_(std::move(place)) {}

    const json &raw() const { return *data_; }
    bool is_null() const { return data_->is_null(); }
    bool has(const std::string &key) const { return data_->is_object() && data_->contains(key); }

    Part operator[](const std::string &key) const {
        if (!has(key)) throw std::invalid_argument(place_ + "." + key + " is missing");
        return Part(data_->at(key), place_ + "." + key);
    }

    // The entries of a list.
    std::vector<Part> parts() const {
        if (!data_->is_array()) fail("a list");
        std::vector<Part> result;
        for (std::size_t i = 0; i < data_->size(); ++i)
            result.emplace_back(data_->at(i), place_ + "[" + std::to_string(i) + "]");
        return result;
    }

    double number() const {
        if (!data_->is_number()) fail("a number");
        return data_->get<double>();
    }
    std::string text() const {
        if (!data_->is_string()) fail("a text");
        return data_->get<std::string>();
    }

    // A vector of any type that is constructed by its size and written by [i].
    template <class Vector>
    Vector vector(std::size_t size) const {
        const std::vector<Part> entries = sized(size, "entries");
        Vector result(size);
        for (std::size_t i = 0; i < size; ++i) result[i] = entries[i].number();
        return result;
    }

    // A matrix of any type that is constructed by its dimensions and written by (i, k).
    template <class Matrix>
    Matrix matrix(std::size_t row_count, std::size_t column_count) const {
        const std::vector<Part> rows = sized(row_count, "rows");
        Matrix result(row_count, column_count);
        for (std::size_t i = 0; i < row_count; ++i) {
            const std::vector<Part> entries = rows[i].sized(column_count, "entries");
            for (std::size_t k = 0; k < column_count; ++k) result(i, k) = entries[k].number();
        }
        return result;
    }

    // A list with the required number of entries.
    std::vector<Part> sized(std::size_t size, const std::string &what = "entries") const {
        const std::vector<Part> result = parts();
        if (result.size() != size)
            throw std::invalid_argument(place_ + " has " + std::to_string(result.size()) + " " + what + ", not " + std::to_string(size));
        return result;
    }

private:
    [[noreturn]] void fail(const std::string &wanted) const {
        throw std::invalid_argument(place_ + " is " + data_->dump().substr(0, 40) + ", not " + wanted);
    }

    const json *data_;
    std::string place_;
};

// A measurement: nothing without a detection, NaN for an entry that is missing (format 2 only).
using Measured = std::optional<std::vector<double>>;

inline Measured measured(const Part &z) {
    if (z.is_null()) return std::nullopt;
    std::vector<double> values;
    for (const Part &entry : z.parts()) values.push_back(entry.is_null() ? std::numeric_limits<double>::quiet_NaN() : entry.number());
    return values;
}

// The name of a problem's filter in `kinds`.
inline std::string kind_of(const Part &problem) {
    const Part filter = problem["filter"];
    if (filter["kind"].text() == "cubature") return filter["rule"].text();
    if (filter.has("iterations") && filter["iterations"].number() > 1) return "extended-iterated";
    const bool is_unmixed = filter["kind"].text() == "fixed-gain" && filter["mixing"].text() == "unmixed";
    return is_unmixed ? "fixed-gain-unmixed" : filter["kind"].text();
}

// Whether the noises of motion and measurement are correlated in a mode.
inline bool has_correlated_noise(const Part &problem) {
    for (const Part &mode : problem["modes"].parts())
        if (mode.has("M")) return true;
    return false;
}

// ----------------------------------------------------------------------------------------------------------- showing a step

// The values that can be shown, in the order of computation: the name, and whether each mode has one.
struct Quantity {
    const char *name;
    bool is_of_mode;
};

inline constexpr Quantity QUANTITIES[] = {
    {"predicted_mode_probabilities", false}, {"mixing_probabilities", true}, {"mixed.mean", true}, {"mixed.covariance", true},
    {"predicted.mean", true}, {"motion_jacobian", true}, {"predicted.covariance", true},
    {"combined_prediction.mean", false}, {"combined_prediction.covariance", false},
    {"converted_measurement", false}, {"converted_covariance", false},
    {"predicted_measurement", true}, {"innovation", true}, {"measurement_jacobian", true}, {"innovation_covariance", true},
    {"cross_covariance", true}, {"gain", true}, {"updated.mean", true}, {"updated.covariance", true}, {"log_likelihood", true},
    {"nis", true}, {"mode_probabilities", false}, {"combined.mean", false}, {"combined.covariance", false}, {"nees", false}};

template <class T, class = void>
struct HasSides : std::false_type {};
template <class T>
struct HasSides<T, std::void_t<decltype(std::declval<T>().rows()), decltype(std::declval<T>().cols())>> : std::true_type {};

// A number, anything that can be iterated as a list, or a matrix by rows in any memory order; one column is a list.
template <class T>
json list(const T &value) {
    if constexpr (std::is_arithmetic_v<T>) {
        return static_cast<double>(value);
    } else {
        json result = json::array();
        if constexpr (HasSides<T>::value) {
            for (decltype(value.rows()) i = 0; i < value.rows(); ++i) {
                json row = json::array();
                for (decltype(value.cols()) k = 0; k < value.cols(); ++k) row.push_back(static_cast<double>(value(i, k)));
                result.push_back(value.cols() == 1 ? row[0] : row);
            }
        } else {
            for (const auto &entry : value) result.push_back(list(entry));
        }
        return result;
    }
}

// The values that a filter shows in a step, from `combined.mean` alone to everything.
class Shown {
public:
    // For all modes together: set("combined.mean", x)
    template <class T>
    Shown &set(const std::string &name, const T &value) {
        return set_in(step_, name, false, list(value));
    }

    // For a mode, counted from 0: set("mixed.mean", j, x)
    template <class T>
    Shown &set(const std::string &name, std::size_t mode, const T &value) {
        json &modes = step_["modes"];
        while (modes.size() <= mode) modes.push_back(json::object());
        return set_in(modes[mode], name, true, list(value));
    }

    const json &step() const { return step_; }

private:
    Shown &set_in(json &object, const std::string &name, bool is_of_mode, json value) {
        const auto is_it = [&](const Quantity &quantity) { return name == quantity.name && quantity.is_of_mode == is_of_mode; };
        if (std::none_of(std::begin(QUANTITIES), std::end(QUANTITIES), is_it))
            throw std::invalid_argument(name + " is no value " + (is_of_mode ? "of a mode" : "of all modes together") +
                                        "; spec/formats.md names them, under A trace");
        const std::size_t dot = name.find('.');
        json &target = dot == std::string::npos ? object[name] : object[name.substr(0, dot)][name.substr(dot + 1)];
        target = std::move(value);
        return *this;
    }

    json step_ = json::object();
};

// -------------------------------------------------------------------------------------------------------------- the protocol

template <class Filter, class = void>
struct TakesEntry : std::false_type {};
template <class Filter>
struct TakesEntry<Filter, std::void_t<decltype(std::declval<Filter &>().step(Measured{}, std::declval<const Part &>()))>>
    : std::true_type {};

// Runs a problem as far as it goes. The filter finds the declared conventions in `problem.conventions`.
template <class Filter>
json answer(const Program &program, json problem) {
    for (const auto &[key, value] : program.conventions) problem["conventions"][key] = value;
    json reply = {{"type", "answer"}, {"id", problem.value("id", "")}, {"steps", json::array()}};
    std::string place;
    try {
        const Part whole(problem);
        Filter filter(whole);
        for (const Part &entry : whole["measurements"].parts()) {
            place = "step " + entry["step"].raw().dump() + ": ";
            json step;
            if constexpr (TakesEntry<Filter>::value)
                step = filter.step(measured(entry["z"]), entry).step();
            else
                step = filter.step(measured(entry["z"])).step();
            step["step"] = entry["step"].raw();
            reply["steps"].push_back(std::move(step));
        }
    } catch (const Skipped &reason) {
        return {{"type", "skipped"}, {"id", reply["id"]}, {"reason", reason.what()}};
    } catch (const Rejected &reason) {
        return {{"type", "rejected"}, {"id", reply["id"]}, {"class", reason.reason_class}, {"reason", reason.what()}};
    } catch (const std::exception &error) {
        reply["error"] = place + error.what();
    } catch (...) {
        reply["error"] = place + "something was thrown that is no std::exception";
    }
    return reply;
}

inline json ready(const Program &program, const json &start) {
    if (start.value("protocol", "") != PROTOCOL)
        throw std::runtime_error("this program speaks " + std::string(PROTOCOL) + ", and was started with " +
                                 start.value("protocol", "no protocol") + ": take the immaculate.hpp of the immaculate that checks it");
    json echo = json::array();
    for (const json &row : start.at("echo").at("matrix")) {
        double sum = 0;
        for (std::size_t k = 0; k < row.size(); ++k) sum += row[k].get<double>() * start["echo"]["vector"].at(k).get<double>();
        echo.push_back(sum);
    }
    return {{"type", "ready"}, {"name", program.name}, {"kinds", program.kinds}, {"formats", program.formats}, {"echo", echo},
            {"conventions", json(program.conventions)}, {"precision", program.precision}, {"validates", program.validates}};
}

// The whole program: answers one message per line until `stop`, and returns the exit status.
template <class Filter>
int speak(const Program &program, std::istream &in = std::cin, std::ostream &out = std::cout) {
    try {
        for (std::string line; std::getline(in, line);) {
            if (line.empty() || line[0] != '{') continue;
            const json message = json::parse(line);
            const std::string type = message.at("type");
            if (type == "stop") break;
            const json reply = type == "start" ? ready(program, message) : answer<Filter>(program, message.at("problem"));
            out << reply.dump() << std::endl;  // with a flush
        }
        return 0;
    } catch (const std::exception &error) {
        std::cerr << "immaculate.hpp: " << error.what() << std::endl;
        return 2;
    }
}

// ------------------------------------------------------------------------------------------- certified cases in unit tests

// A case: its problem, and its trace with values, scale and noise.
struct Case {
    json problem, trace;

    std::string id() const { return problem.at("id"); }

    // The id as a name for a test: letters, digits and `_`.
    std::string name() const {
        std::string result = id();
        const auto is_other = [](unsigned char letter) { return std::isalnum(letter) == 0; };
        std::replace_if(result.begin(), result.end(), is_other, '_');
        return result;
    }
};

inline std::ostream &operator<<(std::ostream &out, const Case &one) { return out << one.id(); }

// The cases of a folder for a program, by name, except those that must be rejected. Their values and noise assume the usual conventions
// in doubles.
inline std::vector<Case> cases(const std::string &folder, const Program &program) {
    const auto has = [](const std::vector<std::string> &all, const std::string &one) {
        return std::find(all.begin(), all.end(), one) != all.end();
    };
    const auto read = [](const std::filesystem::path &file) {
        std::ifstream in(file);
        if (!in) throw std::runtime_error(file.string() + " cannot be read");
        return json::parse(in);
    };
    if (program.precision != "double" || !program.conventions.empty())
        throw std::invalid_argument("a program of other conventions or precision is judged by `immaculate check` alone");
    std::vector<Case> result;
    const std::string end = ".problem.json";
    if (std::filesystem::is_directory(folder)) {
        for (const auto &file : std::filesystem::directory_iterator(folder)) {
            const std::string path = file.path().string();
            if (path.size() <= end.size() || path.substr(path.size() - end.size()) != end) continue;
            Case one{read(path), read(path.substr(0, path.size() - end.size()) + ".trace.json")};
            if (!one.trace.contains("steps")) continue;
            const Part problem(one.problem);
            const bool is_taken = (has(program.kinds, "correlated-noise") || !has_correlated_noise(problem)) &&
                                  (has(program.kinds, "state-conversion") || !problem.has("conversions")) &&
                                  (has(program.kinds, "continuous-chain") || problem.has("transition")) &&
                                  (!problem.has("interaction") || problem["interaction"].text() == "imm" ||
                                   has(program.kinds, problem["interaction"].text()));
            const bool is_asked = has(program.formats, one.problem.at("format")) && has(program.kinds, kind_of(problem)) && is_taken;
            if (is_asked) result.push_back(std::move(one));
        }
    }
    if (result.empty())
        throw std::runtime_error(folder + " has no certified case for this program; `immaculate cases copy " + folder + "` writes them");
    std::sort(result.begin(), result.end(), [](const Case &a, const Case &b) { return a.id() < b.id(); });
    return result;
}

// The result of a case: why it was skipped, or a sentence for each wrong value, in the order of computation.
struct Verdict {
    std::optional<std::string> skipped;
    std::vector<std::string> wrong;
    std::size_t values = 0;  // how many were compared
    bool is_right() const { return !skipped && wrong.empty(); }
    // The first ones; later ones are often their consequence. In long runs a filter whose covariances do not stay symmetric may be right by
    // `immaculate check`, which judges each equation on the filter's own values, and still be too far off here.
    std::string text(std::size_t most = 5) const {
        std::ostringstream result;
        if (skipped) return "skipped: " + *skipped;
        for (std::size_t i = 0; i < std::min(most, wrong.size()); ++i) result << wrong[i] << '\n';
        if (wrong.size() > most)
            result << "and " << wrong.size() - most << " more, which may follow from these: `immaculate check` tells which do\n";
        return result.str();
    }
};

// Compares an answer with a case.
class Comparison {
public:
    explicit Comparison(const Case &one) : case_(one) {}
    Verdict of(const json &reply) {
        const std::string type = reply.at("type");
        if (type == "skipped") {
            verdict_.skipped = reply.at("reason");
        } else if (type == "rejected") {
            complain("it is rejected: " + reply.at("reason").get<std::string>());
        } else {
            const json &expected = case_.trace.at("steps"), &shown = reply.at("steps");
            for (std::size_t k = 0; k < std::min(expected.size(), shown.size()); ++k) check_step(k, expected[k], shown[k]);
            if (reply.contains("error")) complain("it stopped: " + reply["error"].get<std::string>());
            if (verdict_.values == 0) complain("no value is shown");
        }
        return verdict_;
    }

private:
    void complain(const std::string &sentence) { verdict_.wrong.push_back(case_.id() + ": " + sentence); }

    void check_step(std::size_t k, const json &expected, const json &shown) {
        const std::size_t mode_count = expected.at("modes").size();
        for (const Quantity &quantity : QUANTITIES)
            for (std::size_t j = 0; j < (quantity.is_of_mode ? mode_count : 1); ++j) {
                const json *value = at(shown, quantity, j), *right = at(expected, quantity, j);
                // Values that the case does not have, such as a gain without a detection, are ignored.
                if (value != nullptr && right != nullptr) check_value(k, quantity, j, *value, *right);
            }
    }

    void check_value(std::size_t k, const Quantity &quantity, std::size_t j, const json &shown, const json &expected) {
        const std::vector<double> values = numbers(shown), rights = numbers(expected);
        const std::vector<double> scales = numbers(*at(case_.trace.at("scale")[k], quantity, j));
        const double noise = numbers(*at(case_.trace.at("noise")[k], quantity, j)).at(0);
        const std::string place = std::string(quantity.name) + ", step " + std::to_string(k + 1) + mode(quantity, j);
        ++verdict_.values;
        if (shape(shown) != shape(expected) && (values.size() != rights.size() || (is_matrix(shown) && is_matrix(expected))))
            return complain(place + ": it has the shape " + shape(shown) + ", not " + shape(expected));
        const bool is_finite = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
        const bool is_unused = quantity.is_of_mode && case_.trace["steps"][k].at("predicted_mode_probabilities")[j] == 0.0;
        // If rounding is as large as the value's scale, nothing can be decided; and no output depends on a mode of probability zero.
        if (is_finite && (!(LIMIT * noise <= 1) || is_unused)) return;
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double ratio = error(values[i], rights[i], noise, scales[i], is_angle(k, quantity, i));
            if (ratio <= LIMIT) continue;
            std::ostringstream sentence;
            sentence.precision(17);
            sentence << place << entry(expected, i) << ": " << values[i] << " is shown, " << rights[i] << " is certified: ";
            sentence.precision(2);
            sentence << ratio << " times the rounding noise, of which " << static_cast<int>(LIMIT) << " are allowed";
            return complain(sentence.str());
        }
    }

    // The error in rounding noise, as `immaculate check` counts it: the noise is at least a unit roundoff of scale and of the value.
    static double error(double value, double right, double noise, double scale, bool is_angle) {
        const double roundoff = std::numeric_limits<double>::epsilon() / 2, turn = 2 * std::acos(-1.0);
        if (std::isnan(right) && !std::isfinite(value)) return 0;  // a log-likelihood below the least double, which is null in JSON
        double error = std::abs(value - right);
        if (is_angle) error = std::abs(error - turn * std::round(error / turn));
        if (error == 0) return 0;
        const double least = std::max(roundoff * std::abs(right), std::numeric_limits<double>::denorm_min());
        const double ratio = error / std::max(std::max(noise, roundoff) * scale, least);
        return std::isnan(ratio) ? std::numeric_limits<double>::infinity() : ratio;
    }

    // Whether a number counts modulo 2 pi: angles in means of the state and in predicted measurements.
    bool is_angle(std::size_t k, const Quantity &quantity, std::size_t i) const {
        const auto is_declared = [](const json &component) {
            return component == "bearing" || (component.is_array() && component.size() > 2 && component[2] == "angle");
        };
        const std::string name = quantity.name;
        if (name.size() > 5 && name.substr(name.size() - 5) == ".mean") return is_declared(case_.problem.at("state").at(i));
        if (name != "predicted_measurement" || case_.problem["filter"]["kind"] == "converted") return false;
        const json &entry = case_.problem.at("measurements").at(k);
        json sensor = case_.problem.at("measurement");
        if (entry.contains("sensor"))
            for (const json &other : case_.problem.at("sensors"))
                if (other.at("name") == entry["sensor"]) sensor = other.at("measurement");
        const char *key = sensor["kind"] == "range-bearing" ? "components" : "z";
        if (!sensor.contains(key)) return false;
        std::vector<json> there;  // the components that are not missing
        for (std::size_t row = 0; row < sensor[key].size(); ++row)
            if (!entry.at("z").at(row).is_null()) there.push_back(sensor[key][row]);
        return is_declared(there.at(i));
    }

    static const json *at(const json &step, const Quantity &quantity, std::size_t j) {
        std::string pointer = (quantity.is_of_mode ? "/modes/" + std::to_string(j) + "/" : "/") + quantity.name;
        std::replace(pointer.begin(), pointer.end(), '.', '/');
        const json::json_pointer place(pointer);
        return step.contains(place) ? &step.at(place) : nullptr;
    }

    static std::vector<double> numbers(const json &value) {
        if (value.is_number()) return {value.get<double>()};
        if (!value.is_array()) return {std::numeric_limits<double>::quiet_NaN()};
        std::vector<double> result;
        for (const json &part : value)
            for (double number : numbers(part)) result.push_back(number);
        return result;
    }

    static bool is_matrix(const json &value) { return value.is_array() && !value.empty() && value[0].is_array(); }
    static std::string shape(const json &value) {
        if (!value.is_array()) return "of one number";
        const std::string rows = std::to_string(value.size());
        return is_matrix(value) ? rows + " x " + std::to_string(value[0].size()) : rows;
    }

    std::string mode(const Quantity &quantity, std::size_t j) const {
        if (!quantity.is_of_mode) return "";
        return ", modes[" + std::to_string(j) + "] (" + case_.problem.at("modes").at(j).at("name").get<std::string>() + ")";
    }

    static std::string entry(const json &expected, std::size_t i) {
        if (!expected.is_array()) return "";
        if (!is_matrix(expected)) return ", [" + std::to_string(i) + "]";
        return ", [" + std::to_string(i / expected[0].size()) + "][" + std::to_string(i % expected[0].size()) + "]";
    }

    const Case &case_;
    Verdict verdict_;
};

// Runs a filter on a case and compares every value that it shows.
template <class Filter>
Verdict judge(const Program &program, const Case &one) {
    return Comparison(one).of(answer<Filter>(program, one.problem));
}

}  // namespace immaculate
