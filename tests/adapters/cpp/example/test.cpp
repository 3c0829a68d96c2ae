// The filter of imm.hpp in unit tests with GoogleTest: each certified case is a test.
//
//     immaculate cases copy problems
//     IMMACULATE_CASES=problems ctest --test-dir build --output-on-failure

#include "adapter.hpp"

#include <cstdlib>
#include <gtest/gtest.h>

static const std::vector<immaculate::Case> &cases() {
    static const char *folder = std::getenv("IMMACULATE_CASES");
    static const std::vector<immaculate::Case> all = immaculate::cases(folder == nullptr ? "problems" : folder, program());
    return all;
}

class Certified : public testing::TestWithParam<immaculate::Case> {};

TEST_P(Certified, IsRight) {
    const immaculate::Verdict verdict = immaculate::judge<Adapter>(program(), GetParam());
    if (verdict.skipped) GTEST_SKIP() << *verdict.skipped;
    EXPECT_TRUE(verdict.is_right()) << verdict.text();
}

INSTANTIATE_TEST_SUITE_P(Cases, Certified, testing::ValuesIn(cases()), [](const auto &info) { return info.param.name(); });

// A mixed covariance that is half of what it must be is found, and named.
struct Mistaken : Adapter {
    using Adapter::Adapter;
    immaculate::Shown step(const immaculate::Measured &z, const immaculate::Part &entry) {
        immaculate::Shown shown = Adapter::step(z, entry);
        auto halved = shown.step()["modes"][0]["mixed"]["covariance"].get<std::vector<std::vector<double>>>();
        for (auto &row : halved)
            for (double &value : row) value /= 2;
        return shown.set("mixed.covariance", 0, halved);
    }
};

TEST(AMistake, IsFoundInItsEquationStepAndMode) {
    for (const immaculate::Case &one : cases()) {
        if (one.id() != "mixing.two-modes") continue;
        const immaculate::Verdict verdict = immaculate::judge<Mistaken>(program(), one);
        ASSERT_EQ(verdict.wrong.size(), 1U) << verdict.text();
        EXPECT_EQ(verdict.wrong[0].find("mixing.two-modes: mixed.covariance, step 1, modes[0] ("), 0U) << verdict.text();
        EXPECT_NE(verdict.wrong[0].find("times the rounding noise, of which 100 are allowed"), std::string::npos) << verdict.text();
        return;
    }
    FAIL() << "the folder has no mixing.two-modes";
}
