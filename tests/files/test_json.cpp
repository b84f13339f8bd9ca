#include <algorithm>
#include <doctest/doctest.h>
#include <type_traits>

#include "files/json.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

std::string refusal(const char* text, void (*read)(JsonReader&)) {
    return message_of([&] {
        const Json root = parse_json(text, "slab.json");
        JsonReader json(root, "slab.json");
        read(json);
        json.finish();
    });
}

void read_young(JsonReader& json) { json.number("young_Pa", kPositive); }

}  // namespace

TEST_CASE("json: what may be left out is among what was expected, too") {
    const auto read = [](JsonReader& json) {
        json.text("name", "");
        json.number("size_mm", {0.0, 1.0}, 0.5);
        json.integer("count", 1, 2, 1);
        json.boolean("on", false);
        json.finish();
    };
    CHECK(refusal(R"({"size_mm": 1, "unheard": 1})", read) ==
          "slab.json: unheard: found an unknown key, expected one of name size_mm count on");
}

TEST_CASE("json: comments are allowed") {
    const Json root = parse_json("// a scene\n{\"a\": 1 /* one */}", "x.json");
    CHECK(root["a"] == 1);
}

TEST_CASE("json: messages name file, key, what was found and what was expected") {
    CHECK(refusal(R"({"young_Pa": 3})", read_young) == "");
    CHECK(refusal(R"({"young_Pa": -3})", read_young) == "slab.json: young_Pa: found -3, expected a number > 0");
    CHECK(refusal(R"({"young_Pa": 0})", read_young) == "slab.json: young_Pa: found 0, expected a number > 0");
    CHECK(refusal(R"({"young_Pa": "3"})", read_young) == "slab.json: young_Pa: found '3', expected a number > 0");
    CHECK(refusal(R"({})", read_young) == "slab.json: young_Pa: found nothing, expected a number > 0");
    CHECK(refusal(R"({"young_Pa": 3, "yung": 4})", read_young) ==
          "slab.json: yung: found an unknown key, expected one of young_Pa");
    CHECK(refusal(R"({"young_Pa": 3, "young_Pa": 4})", read_young) ==
          "slab.json: young_Pa: found the key twice, expected it once");
    CHECK(refusal(R"([1, 2])", read_young) == "slab.json: found an array of 2, expected an object { ... }");
    CHECK(contains(refusal("{\n  \"young_Pa\": 3,,\n}", read_young), "slab.json: line 2, column"));
    CHECK(contains(refusal("{\"young_Pa\": 1e999}", read_young), "slab.json"));
    CHECK(contains(refusal("", read_young), "not valid JSON"));
    CHECK(contains(refusal("{\"young_Pa\": 3", read_young), "not valid JSON"));
}

TEST_CASE("json: arrays, choices and whole numbers") {
    const auto size = [](JsonReader& json) { json.numbers("size", 2, kPositive); };
    CHECK(contains(refusal(R"({"size": [1]})", size), "found an array of 1, expected an array of 2 numbers"));
    CHECK(contains(refusal(R"({"size": [1, -1]})", size), "found -1"));
    const auto kind = [](JsonReader& json) { json.choice("kind", {"direct", "indirect"}); };
    CHECK(refusal(R"({"kind": "both"})", kind) == "slab.json: kind: found 'both', expected one of direct indirect");
    const auto count = [](JsonReader& json) { json.integer("n", 0, 10); };
    CHECK(contains(refusal(R"({"n": 2.5})", count), "expected a whole number from 0 to 10"));
    CHECK(contains(refusal(R"({"n": 1e30})", count), "expected a whole number from 0 to 10"));
    const auto version = [](JsonReader& json) { json.integer("n", 1, 1); };
    CHECK(refusal(R"({"n": 2})", version) == "slab.json: n: found 2, expected 1");
    const auto nested = [](JsonReader& json) {
        JsonReader inner = json.object("avatar");
        inner.finish();
    };
    CHECK(contains(refusal(R"({"avatar": {"x": 1}})", nested), "slab.json: avatar.x: found an unknown key"));
}

TEST_CASE("json: with only() a misspelt key is named, not the missing one") {
    const Json json = parse_json(R"({"young_kPa": 2.5, "poisson": 0.45})", "c.json");
    const JsonReader reader(json, "c.json", "gel");
    CHECK(message_of([&] {
              reader.only({"young_Pa", "poisson"});
          }) == "c.json: gel.young_kPa: found an unknown key, expected one of young_Pa poisson (is young_Pa meant?)");
    CHECK_NOTHROW(reader.only({"young_kPa", "poisson", "law"}));
    CHECK(contains(message_of([&] { reader.fail("", "nothing", "something"); }), "c.json: gel: found nothing"));
}

TEST_CASE("json: an object is read where it lies, never a temporary") {
    static_assert(std::is_constructible_v<JsonReader, const Json&, std::string>);
    static_assert(!std::is_constructible_v<JsonReader, Json, std::string>);
    static_assert(!std::is_constructible_v<JsonReader, const Json, std::string, std::string>);
    static_assert(!std::is_constructible_v<JsonReader, const char*, std::string>);  // would become one
    const auto make = [] { return parse_json(R"({"n": 3})", "c.json"); };
    const Json kept = make();
    CHECK(JsonReader(kept, "c.json").integer("n", 0, 9) == 3);
}

TEST_CASE("json: of the keys that are known the nearest to a misspelt one is named, if any is near") {
    const auto said = [](const char* key) {
        const Json json{{key, 1}};
        const JsonReader reader(json, "c.json", "tissue");
        return message_of([&] { reader.only({"linear", "map", "stiffness_scale"}); });
    };
    CHECK(contains(said("mapp"),
                   "tissue.mapp: found an unknown key, expected one of linear map stiffness_scale (is map meant?)"));
    CHECK(contains(said("amp"), "(is map meant?)"));
    CHECK(contains(said("Linear"), "(is linear meant?)"));
    CHECK(contains(said("stifness_scal"), "(is stiffness_scale meant?)"));
    CHECK_FALSE(contains(said("colour"), "meant"));
    CHECK_FALSE(contains(said(std::string(100'000, 'm').c_str()), "meant"));
}

TEST_CASE("json: what a broken file holds does not steer the terminal that shows the message, nor flood it") {
    const std::string escapes = message_of([] { parse_json("{\"a\x1b[2J\x7f\": \x07}", "x.json"); });
    CHECK(contains(escapes, "x.json: line 1"));
    CHECK(std::none_of(escapes.begin(), escapes.end(), [](char c) { return (c >= 0 && c < 0x20) || c == 0x7f; }));
    const auto unknown = [](JsonReader&) {};
    CHECK(refusal("{\"a\\u001b[31m\": 1}", unknown) == "slab.json: a?[31m: found an unknown key, expected one of");
    CHECK(refusal("{\"a\\u009bm\\u00e4\": 1}", unknown) ==
          "slab.json: a?m\xc3\xa4: found an unknown key, expected one of");
    const std::string endless = "{\"a\": \"" + std::string(100'000, 'x');
    CHECK(message_of([&] { parse_json(endless, "x.json"); }).size() < 5'000);
}

TEST_CASE("json: a zero byte in a text, which would cut a file's name short, is refused with its key") {
    const Json json = parse_json(R"({"file": "a.msh\u0000b", "good": "a.msh"})", "c.json");
    JsonReader reader(json, "c.json");
    const std::string message = message_of([&] { reader.text("file"); });
    CHECK(contains(message, "c.json: file: found 'a.msh?b' with a zero byte"));
    CHECK(reader.text("good") == "a.msh");
}
