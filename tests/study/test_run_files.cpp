#include <cmath>
#include <doctest/doctest.h>

#include "files/text.h"
#include "study/run_files.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("run files: marks on a found nodule count once, with the highest rating; the others are false marks") {
    RunSettings settings;
    settings.tissue = "map";
    settings.nodules = {{"A", 10.0}, {"B", 4.0}};
    const std::vector<LoggedMark> marks{{"A", 2.0, true, 3.0},
                                        {"A", 9.9, false, 5.0},  // within A's diameter
                                        {"A", 10.1, false, 2.0},
                                        {"B", 3.0, false, 1.0},  // B was not found
                                        {"n/a", 40.0, false, 4.0}};
    const JudgedCase judged = judged_case(settings, marks);
    CHECK(judged.rated);
    CHECK(judged.id == "map");
    CHECK(judged.lesions == std::vector<std::string>{"A", "B"});
    CHECK(judged.reading.ll == std::vector<double>{5.0, kUnmarked});
    CHECK(judged.reading.nl == std::vector<double>{2.0, 1.0, 4.0});
    CHECK_FALSE(judged_case(settings, {{"A", 2.0, true}}).rated);
    CHECK(judged_case({}, {}).lesions.empty());
}

TEST_CASE("run files: ratings are whole numbers from 1 to 5, or n/a") {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& rating) {
        palpa::files::write_text_atomically(folder / "marks.tsv",
                                            "nodule\tdistance_mm\thit\tconfidence\nA\t2\t1\t" + rating + "\n");
        std::vector<std::string> notes;
        return read_marks_left(folder / "marks.tsv", notes)->front().confidence;
    };
    CHECK(read("4") == 4.0);
    CHECK(std::isnan(read("n/a")));
    for (const char* rating : {"0", "6", "2.5"}) {
        CAPTURE(rating);
        CHECK(contains(message_of([&] { read(rating); }), "a whole number from 1 to 5"));
    }
}
