#include <doctest/doctest.h>

#include "files/json.h"
#include "files/text.h"
#include "study/trial_log.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("trial log: every row is in the file when write returns, explained column by column") {
    const TemporaryFolder folder;
    const RunFiles files = next_run(folder.path(), "07");
    TrialLog log(files);
    EventRow event;
    event.trial_type = "mark";
    event.block = "test";
    event.onset_s = 1.5;
    event.x_mm = 12.5;
    event.y_mm = 30.0;
    REQUIRE(log.write(event));
    MarkRow mark;
    mark.x_mm = 12.5;
    mark.nodule = "A";
    mark.hit = 1;
    REQUIRE(log.write(mark));
    const std::string events = read_text(files.file("_events.tsv"));
    CHECK(events ==
          "onset\tduration\ttrial_type\tblock\ttrial\torder_id\tcondition\tdevice_id\tcalibration_id\tmap_id\t"
          "map_rotation_deg\tmap_flip\tseed\tn_nodules\ttp\tfp\tfn\tpath_mm\tmean_force_N\tmax_force_N\tx_mm\ty_mm\n"
          "1.5\tn/a\tmark\ttest\t1\tn/a\tn/a\tn/a\tn/a\tn/a\t0\t0\t0\t0\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\t12.5\t30\n");
    CHECK(read_text(files.file("_marks.tsv")) ==
          "onset\ttrial\tmark\tx_mm\ty_mm\tconfidence\tnodule\tdistance_mm\thit\n0\t1\t1\t12.5\t0\tn/a\tA\tn/a\t1\n");
    const Json explained = read_json(files.file("_events.json"));
    CHECK(explained["onset"]["Units"] == "s");
    CHECK(read_json(files.file("_marks.json")).size() == 9);
    CHECK_THROWS_AS(TrialLog{files}, std::runtime_error);  // nothing is overwritten
}
