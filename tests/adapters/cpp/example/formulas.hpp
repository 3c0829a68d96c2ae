// Formulas of the entries of a state, as spec/formats.md has them under Format 2, with their slopes by forward differentiation.
//
// A formula is read anew at every evaluation: slow, short, and with no syntax tree.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// A number, and its slopes along the entries of the state.
struct Dual {
    double value;
    Eigen::VectorXd slopes;

    // A function of this number: its value, and its slope there.
    Dual mapped(double of_value, double slope) const { return {of_value, slope * slopes}; }
};

inline Dual operator+(const Dual &a, const Dual &b) { return {a.value + b.value, a.slopes + b.slopes}; }
inline Dual operator-(const Dual &a, const Dual &b) { return {a.value - b.value, a.slopes - b.slopes}; }
inline Dual operator*(const Dual &a, const Dual &b) { return {a.value * b.value, b.value * a.slopes + a.value * b.slopes}; }
inline Dual operator/(const Dual &a, const Dual &b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.slopes - quotient * b.slopes) / b.value};
}

// The Stumpff function c_k(t), the sum over j of (-t)^j / (2j + k)!; far from zero by c_(k+2) = (1/k! - c_k) / t, where the sum cancels.
inline double stumpff(int k, double t) {
    if (std::abs(t) <= 9) {
        double term = 1 / std::tgamma(k + 1.0), sum = 0;
        for (int j = 1; sum + term != sum; ++j) {
            sum += term;
            term *= -t / ((2 * j + k - 1.0) * (2 * j + k));
        }
        return sum;
    }
    const double root = std::sqrt(std::abs(t));
    if (k == 0) return t > 0 ? std::cos(root) : std::cosh(root);
    if (k == 1) return (t > 0 ? std::sin(root) : std::sinh(root)) / root;
    return (1 / std::tgamma(k - 1.0) - stumpff(k - 2, t)) / t;
}

// What formulas may name: numbers, entries of the state, and other formulas (`let`).
class Names {
public:
    std::map<std::string, double> numbers;
    std::vector<std::string> state;
    std::vector<std::pair<std::string, std::string>> definitions;

    // A formula at a state; of an empty state, a formula of numbers alone.
    Dual of(const std::string &formula, const Eigen::VectorXd &at) const;
};

// The grammar, from the weakest operation to the strongest.
class Reader {
public:
    Reader(const std::string &text, const Names &names, const Eigen::VectorXd &at) : text_(text), names_(names), at_(at) {}

    Dual whole() {
        const Dual result = sum();
        if (next() != 0) fail("an operator is missing");
        return result;
    }

private:
    Dual sum() {
        Dual left = product();
        while (true) {
            if (take('+'))
                left = left + product();
            else if (take('-'))
                left = left - product();
            else
                return left;
        }
    }

    Dual product() {
        Dual left = sign();
        while (true) {
            if (take('*'))
                left = left * sign();
            else if (take('/'))
                left = left / sign();
            else
                return left;
        }
    }

    Dual sign() {
        if (take('-')) return constant(0) - sign();
        return take('+') ? sign() : power();
    }

    Dual power() {
        const Dual base = atom();
        const bool is_power = take('^') || (text_.compare(place_, 2, "**") == 0 && take('*') && take('*'));
        if (!is_power) return base;
        const bool is_opened = take('('), is_negative = take('-');
        take('+');
        if (std::isdigit(next()) == 0) fail("the exponent is not an integer");
        const double exponent = (is_negative ? -1 : 1) * number();
        if (is_opened) close();
        const double slope = exponent == 0 ? 0 : exponent * std::pow(base.value, exponent - 1);
        return base.mapped(std::pow(base.value, exponent), slope);
    }

    Dual atom() {
        const char first = next();
        if (take('(')) {
            const Dual inner = sum();
            close();
            return inner;
        }
        if (std::isdigit(first) != 0 || first == '.') return constant(number());
        if (!is_name_part(first)) fail("a value is missing");
        std::string name;
        while (is_name_part(next(false))) name += text_[place_++];
        return take('(') ? call(name) : word(name);
    }

    Dual word(const std::string &name) {
        if (name == "pi") return constant(std::acos(-1.0));
        for (std::size_t i = 0; i < names_.state.size(); ++i)
            if (names_.state[i] == name && at_.size() > 0) return {at_(i), Eigen::VectorXd::Unit(at_.size(), i)};
        for (const auto &[defined, formula] : names_.definitions)
            if (defined == name) return names_.of(formula, at_);
        const auto found = names_.numbers.find(name);
        if (found == names_.numbers.end()) fail("`" + name + "` is not known here");
        return constant(found->second);
    }

    Dual call(const std::string &name) {
        const Dual a = sum();
        if (name == "atan2" || name == "hypot") {
            if (!take(',')) fail(name + " has two arguments");
            const Dual b = sum();
            close();
            const double square = a.value * a.value + b.value * b.value, length = std::hypot(a.value, b.value);
            if (name == "hypot") return {length, (a.value * a.slopes + b.value * b.slopes) / length};
            return {std::atan2(a.value, b.value), (b.value * a.slopes - a.value * b.slopes) / square};
        }
        close();
        const double x = a.value;
        if (name == "sqrt") return a.mapped(std::sqrt(x), 0.5 / std::sqrt(x));
        if (name == "exp") return a.mapped(std::exp(x), std::exp(x));
        if (name == "ln") return a.mapped(std::log(x), 1 / x);
        if (name == "sin") return a.mapped(std::sin(x), std::cos(x));
        if (name == "cos") return a.mapped(std::cos(x), -std::sin(x));
        if (name == "tan") return a.mapped(std::tan(x), 1 + std::tan(x) * std::tan(x));
        if (name.size() != 2 || name[0] != 'c' || std::isdigit(name[1]) == 0) fail("there is no function `" + name + "`");
        const int k = name[1] - '0';
        return a.mapped(stumpff(k, x), (k * stumpff(k + 2, x) - stumpff(k + 1, x)) / 2);
    }

    Dual constant(double value) const { return {value, Eigen::VectorXd::Zero(at_.size())}; }

    double number() {
        char *end = nullptr;
        const double value = std::strtod(text_.c_str() + place_, &end);
        place_ = end - text_.c_str();
        return value;
    }

    static bool is_name_part(char letter) { return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_'; }

    // The next character, after spaces if they are skipped; 0 at the end.
    char next(bool skips_spaces = true) {
        while (skips_spaces && place_ < text_.size() && text_[place_] == ' ') ++place_;
        return place_ < text_.size() ? text_[place_] : 0;
    }

    bool take(char wanted) {
        if (next() != wanted) return false;
        ++place_;
        return true;
    }

    void close() {
        if (!take(')')) fail("`)` is missing");
    }

    [[noreturn]] void fail(const std::string &reason) const {
        throw std::invalid_argument("column " + std::to_string(place_ + 1) + " of `" + text_ + "`: " + reason);
    }

    const std::string &text_;
    const Names &names_;
    const Eigen::VectorXd &at_;
    std::size_t place_ = 0;
};

inline Dual Names::of(const std::string &formula, const Eigen::VectorXd &at) const { return Reader(formula, *this, at).whole(); }
