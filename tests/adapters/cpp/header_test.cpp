// What immaculate.hpp does with what goes wrong: each error is a sentence with its place. No filter is needed for it.

#include <gtest/gtest.h>
#include <immaculate.hpp>

using immaculate::json;
using immaculate::Part;

// Reads a matrix, and stops at the second step.
struct Stopping {
    explicit Stopping(const Part &problem) { problem["F"].matrix<Square>(2, 2); }
    immaculate::Shown step(const immaculate::Measured &z) {
        if (!z) throw std::runtime_error("singular matrix");
        return immaculate::Shown().set("combined.mean", *z);
    }

    struct Square {
        Square(std::size_t, std::size_t) {}
        double &operator()(std::size_t, std::size_t) { return value; }
        double value = 0;
    };
};

static json problem(const json &F) {
    return {{"id", "mine"}, {"F", F}, {"measurements", {{{"step", 1}, {"z", {5}}}, {{"step", 2}, {"z", nullptr}}}}};
}

TEST(AnException, BecomesTheErrorOfItsStep) {
    const json reply = immaculate::answer<Stopping>({}, problem({{1, 2}, {3, 4}}));
    EXPECT_EQ(reply["error"], "step 2: singular matrix");
    EXPECT_EQ(reply["steps"], json::parse(R"([{"step": 1, "combined": {"mean": [5]}}])"));
}

TEST(AWrongSize, IsSaidWithItsPlace) {
    EXPECT_EQ(immaculate::answer<Stopping>({}, problem({{1, 2}}))["error"], "problem.F has 1 rows, not 2");
    EXPECT_EQ(immaculate::answer<Stopping>({}, problem({{1, 2}, {3}}))["error"], "problem.F[1] has 1 entries, not 2");
    EXPECT_EQ(immaculate::answer<Stopping>({}, problem({{1, 2}, {3, "4"}}))["error"], "problem.F[1][1] is \"4\", not a number");
    EXPECT_EQ(immaculate::answer<Stopping>({}, json::object())["error"], "problem.F is missing");
}

TEST(AValue, ThatATraceDoesNotHaveIsRefused) {
    immaculate::Shown shown;
    EXPECT_THROW(shown.set("mixed_mean", 0, 1.0), std::invalid_argument);
    EXPECT_THROW(shown.set("mixed.mean", 1.0), std::invalid_argument) << "it is of a mode";
    EXPECT_THROW(shown.set("combined.mean", 0, 1.0), std::invalid_argument) << "it is of all modes together";
}

TEST(AnotherProtocol, IsRefusedWithASentence) {
    std::istringstream in(R"({"type": "start", "protocol": "immaculate-check/2", "echo": {"matrix": [[1]], "vector": [1]}})");
    std::ostringstream out;
    testing::internal::CaptureStderr();
    EXPECT_EQ(immaculate::speak<Stopping>({}, in, out), 2);
    EXPECT_EQ(out.str(), "");
    EXPECT_NE(testing::internal::GetCapturedStderr().find("speaks immaculate-check/1, and was started with immaculate-check/2"),
              std::string::npos);
}

TEST(AFolderWithoutCases, SaysHowToWriteThem) {
    try {
        immaculate::cases("no-such-folder", {});
        FAIL();
    } catch (const std::runtime_error &error) {
        EXPECT_NE(std::string(error.what()).find("`immaculate cases copy no-such-folder` writes them"), std::string::npos);
    }
}

// A step is shown, and what is found in it: of an angle, by two modes of which one cannot be, and of the second entry of a measurement.
static std::string found(const json &shown) {
    const json problem = json::parse(R"({"id": "one", "filter": {"kind": "extended"}, "modes": [{"name": "slow"}, {"name": "fast"}],
        "state": [["a", "rad", "angle"]], "measurement": {"kind": "range-bearing", "components": ["range", "bearing"]},
        "measurements": [{"step": 1, "z": [null, 3]}]})");
    const json trace = json::parse(R"({
        "steps": [{"predicted_mode_probabilities": [1, 0], "modes": [
            {"gain": [[1, 2]], "predicted_measurement": [3.1], "innovation": [3.1], "log_likelihood": null}, {"gain": [[1, 2]]}],
            "combined": {"mean": [3.1], "covariance": [[1]]}}],
        "scale": [{"predicted_mode_probabilities": [1, 1], "modes": [
            {"gain": [[1, 1]], "predicted_measurement": [1], "innovation": [1], "log_likelihood": 1}, {"gain": [[1, 1]]}],
            "combined": {"mean": [1], "covariance": [[1]]}}],
        "noise": [{"predicted_mode_probabilities": 1e-16, "modes": [
            {"gain": 1e-16, "predicted_measurement": 1e-16, "innovation": 1e-16, "log_likelihood": 0}, {"gain": 1e-16}],
            "combined": {"mean": 1e-16, "covariance": 0.011}}]})");
    const immaculate::Case one{problem, trace};
    return immaculate::Comparison(one).of({{"type", "answer"}, {"steps", {shown}}}).text();
}

static json gains(const json &slow, const json &fast) { return {{"modes", {{{"gain", slow}}, {{"gain", fast}}}}}; }

TEST(AComparison, AllowsHundredTimesTheNoiseOfAtLeastAUnitRoundoff) {
    EXPECT_EQ(found(gains({{1.0, 2.0 + 1e-14}}, {{1.0, 2.0}})), "");
    EXPECT_EQ(found(gains({{1.0, 2.0 + 3e-14}}, {{1.0, 2.0}})).find("one: gain, step 1, modes[0] (slow), [0][1]: 2.00000000000003"), 0U);
}

static json of_slow(const char *name, const json &value) { return {{"modes", {{{name, value}}, json::object()}}}; }

TEST(AComparison, KnowsAnglesOfWhatIsMeasuredAndLikelihoodsOfZero) {
    const double turn = 2 * std::acos(-1.0);
    EXPECT_EQ(found(of_slow("predicted_measurement", {3.1 - turn})), "");
    EXPECT_NE(found(of_slow("innovation", {3.1 - turn})), "") << "it is wrapped, and no angle";
    EXPECT_EQ(found(of_slow("log_likelihood", -INFINITY)), "");
    EXPECT_EQ(found(of_slow("log_likelihood", nullptr)), "");
    EXPECT_NE(found(of_slow("log_likelihood", -800.0)), "");
}

TEST(AComparison, KnowsShapesUnusedModesNoiseAndWhatIsNotFinite) {
    EXPECT_EQ(found({{"combined", {{"covariance", {{5.0}}}}}}), "") << "nobody can tell";
    EXPECT_NE(found({{"combined", {{"covariance", {{NAN}}}}}}), "");
    EXPECT_EQ(found(gains({{1.0}, {2.0}}, {{1.0, 2.0}})), "one: gain, step 1, modes[0] (slow): it has the shape 2 x 1, not 1 x 2\n");
    EXPECT_EQ(found(gains({{1.0, 2.0}}, {{1.0, 7.0}})), "") << "nothing depends on a mode of probability zero";
    EXPECT_NE(found(gains({{1.0, 2.0}}, {{1.0, NAN}})), "");
    EXPECT_NE(found(gains({{NAN, 2.0}}, {{1.0, 2.0}})), "");
    EXPECT_EQ(found({{"combined", {{"mean", {3.1 - 2 * std::acos(-1.0)}}}}}), "");
    EXPECT_NE(found({{"combined", {{"mean", {3.1 - std::acos(-1.0)}}}}}), "");
    EXPECT_EQ(found(json::object()), "one: no value is shown\n");
}
