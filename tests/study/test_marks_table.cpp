#include <doctest/doctest.h>

#include "files/input_error.h"
#include "files/text.h"
#include "study/marks_table.h"
#include "study/observations.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::study;
using namespace palpa::test;

namespace {

const std::string kMarksHeader = "condition\tparticipant\tcase\tkind\tlesion\trating\n";
const std::string kGoodMarks =
    "a\tp1\tc1\tlesion\tL1\t4\na\tp1\tc1\tlesion\tL2\tn/a\na\tp1\tc1\tnl\tn/a\t2\n"
    "a\tp1\tc2\tcase\tn/a\tn/a\na\tp2\tc1\tlesion\tL2\t1\na\tp2\tc1\tlesion\tL1\tn/a\na\tp2\tc2\tnl\tn/a\t3\n";

Observations marks(const std::string& rows, const RatingScale& scale = {}) {
    const TemporaryFolder folder;
    palpa::files::write_text_atomically(folder / "marks.tsv", kMarksHeader + rows);
    return read_counts(folder / "marks.tsv", scale);
}

}  // namespace

TEST_CASE("marks table: lesions, false marks and empty cases become readings and counts") {
    const Observations seen = marks(kGoodMarks);
    REQUIRE(seen.judged.size() == 4);
    CHECK(seen.judged[0].lesions == std::vector<std::string>{"L1", "L2"});
    CHECK(seen.judged[0].reading.ll == std::vector<double>{4.0, kUnmarked});
    CHECK(seen.judged[0].reading.nl == std::vector<double>{2.0});
    CHECK(seen.judged[1].lesions.empty());
    CHECK(seen.judged[2].reading.ll == std::vector<double>{kUnmarked, 1.0});  // whatever the order of the rows
    CHECK(seen.nodules == std::vector<std::string>{"c1 L1", "c1 L2"});
    std::int64_t tp = 0, fn = 0, fp = 0;
    for (const Observation& row : seen.rows) {
        tp += row.tp;
        fn += row.fn;
        fp += row.fp;
    }
    CHECK(tp == 2);
    CHECK(fn == 2);
    CHECK(fp == 2);
}

TEST_CASE("marks table: what cannot be right is refused with its line and column") {
    const auto refused = [](const std::string& rows, const char* part, const RatingScale& scale = {}) {
        const std::string said = message_of([&] { marks(rows, scale); });
        CAPTURE(said);
        CHECK(contains(said, part));
    };
    refused(kGoodMarks + "a\tp2\tc2\tnl\tn/a\tn/a\n", "a mark has a rating");
    refused(kGoodMarks + "a\tp2\tc2\tnl\tn/a\t6\n", "a rating from 1 to 5, the scale", {1.0, 5.0});
    refused(kGoodMarks + "a\tp2\tc2\tcase\tn/a\tn/a\n", "no row case beside other rows");
    refused(kGoodMarks + "a\tp1\tc2\tnl\tn/a\t1\n", "no row case beside other rows");
    refused(kGoodMarks + "a\tp1\tc1\tlesion\tL1\t3\n", "each lesion of a case once");
    refused(kGoodMarks + "a\tp3\tc1\tlesion\tL1\t3\n", "one row for each lesion of the case");
    refused(kGoodMarks + "a\tp3\tc1\tnl\tn/a\t3\n", "no lesion of 'c1' for 'p3'");
    refused(kGoodMarks + "a\tp3\tc1\thit\tL1\t3\n", "lesion, nl or case");
    refused(kGoodMarks + "a\tp3\tc2\tnl\tL1\t3\n", "n/a in a row nl");
    refused("", "no rows");
}
