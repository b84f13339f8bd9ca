#include <CLI/CLI.hpp>
#include <cstdint>
#include <doctest/doctest.h>
#include <optional>

#include "app/commands/option_checks.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::app;
using namespace palpa::test;

namespace {

struct Options {
    double length_mm = 0.0;
    double free = 0.0;
    std::optional<double> maybe;
    std::vector<double> several;
    std::string kind;
    std::string name;
    std::uint64_t seed = 0;
    int count = 0;
    bool flag = false;
};

// What is said of these arguments; "" if they are taken.
std::string refusal(std::vector<std::string> arguments) {
    Options options;
    CLI::App app;
    CLI::App* below = app.add_subcommand("do");
    below->add_option("--length-mm", options.length_mm)->check(CLI::Range(0.0, 10.0));
    below->add_option("--free", options.free);
    below->add_option("--maybe", options.maybe);
    below->add_option("--several", options.several)->expected(2);
    below->add_option("--seed", options.seed);
    below->add_option("--seed-to-20", options.seed)->check(CLI::Range(0, 20));
    below->add_option("--count", options.count);
    below->add_flag("--flag", options.flag);
    below->add_option("--name", options.name);
    below->add_option("--kind", options.kind)->check(one_of({"sphere", "cylinder", "cone"}));
    refuse_what_is_no_value(app);
    arguments.push_back("do");
    try {
        app.parse(arguments);  // CLI11 takes them from the back
    } catch (const CLI::ParseError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("option checks: no option takes what is no number") {
    for (const char* value : {"nan", "NaN", "-nan", "inf", "-inf", "infinity", "1e999"}) {
        CAPTURE(value);
        for (const char* option : {"--length-mm", "--free", "--maybe"}) CHECK_FALSE(refusal({value, option}).empty());
        CHECK_FALSE(refusal({value, "1", "--several"}).empty());
        CHECK_FALSE(refusal({"1", value, "--several"}).empty());
    }
    CHECK(contains(refusal({"nan", "--free"}), "--free: found 'nan', expected a finite number"));
    for (const char* option : {"--length-mm", "--free", "--maybe"}) CHECK(refusal({"3.5", option}).empty());
    CHECK(refusal({"-2", "1e3", "--several"}).empty());
}

TEST_CASE("option checks: a word for a number is no number, not one out of range") {
    for (const char* value : {"abc", "5mm", "1.5.2"}) {
        CAPTURE(value);
        CHECK(contains(refusal({value, "--length-mm"}), "--length-mm: found"));
    }
    CHECK(contains(refusal({"abc", "--length-mm"}), "--length-mm: found 'abc', expected a number"));
    CHECK(contains(refusal({"abc", "--count"}), "--count: found 'abc', expected a whole number"));
    CHECK(contains(refusal({"1.5", "--count"}), "--count: found '1.5', expected a whole number"));
    CHECK(contains(refusal({"x", "--seed"}), "--seed: found 'x', expected a whole number from 0"));
    CHECK(contains(refusal({"11", "--length-mm"}), "not in range"));
}

TEST_CASE("option checks: a command that is not there is named, with those that are") {
    CLI::App app("", "palpa");
    app.require_subcommand(1);
    CLI::App* maps = app.add_subcommand("maps");
    maps->require_subcommand(1);
    for (const char* name : {"info", "plot", "export"}) maps->add_subcommand(name);
    const auto said = [&](const std::vector<std::string>& arguments) {
        return message_of([&] { check_subcommands(app, arguments); });
    };
    CHECK(said({"maps", "inof", "x.map"}) == "maps: found 'inof', expected info, plot or export");
    CHECK(said({"maps", "info", "inof"}).empty());
    maps->get_subcommand("plot")->alias("draw");
    CHECK(said({"maps", "draw"}).empty());
    CHECK(said({"maps", "--help"}).empty());
    CHECK(said({"maps"}).empty());  // nothing is there to name: CLI11 says that a subcommand is required
}

TEST_CASE("option checks: words are listed as a person lists them") {
    CHECK(contains(refusal({"ball", "--kind"}), "--kind: found 'ball', expected sphere, cylinder or cone"));
    CHECK(refusal({"cone", "--kind"}).empty());
}

TEST_CASE("option checks: nothing is no value") {
    CHECK(contains(refusal({"", "--name"}), "--name: found nothing, expected a value"));
    CHECK(refusal({"x", "--name"}).empty());
    for (const char* option : {"--free", "--maybe", "--count", "--seed"}) CHECK_FALSE(refusal({"", option}).empty());
    CHECK(refusal({"--flag"}).empty());
}

TEST_CASE("option checks: a number from 0 upwards does not begin again at its end") {
    for (const char* value : {"-1", "99999999999999999999", "-99999999999999999999"}) {
        CHECK(contains(refusal({value, "--seed"}),
                       "--seed: found '" + std::string(value) + "', expected a whole number from 0"));
    }
    CHECK(refusal({"18446744073709551615", "--seed"}).empty());
    CHECK(refusal({"-1", "--count"}).empty());
}

TEST_CASE("option checks: an unsigned number with a range of its own is refused with that range") {
    CHECK(refusal({"20", "--seed-to-20"}).empty());
    for (const char* value : {"-1", "21"}) CHECK(contains(refusal({value, "--seed-to-20"}), "not in range 0 to 20"));
    CHECK(contains(refusal({"-1", "--seed"}), "expected a whole number from 0 to 18446744073709551615"));
}
