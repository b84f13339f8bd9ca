#include <doctest/doctest.h>

#include "files/json.h"
#include "files/text.h"
#include "study/sample_log.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("sample log: header, rows and explanation agree; missing is n/a") {
    const TemporaryFolder folder;
    const RunFiles files = next_run(folder.path(), "07");
    {
        SampleLog log(files);
        SampleRow row;
        row.t_host_s = 0.1;
        row.tool = "pen";
        row.saturated = 1;
        log.write(row);
        CHECK(log.sync());
    }
    CHECK(files.folder == folder / "sub-07/beh");
    const std::string text = read_text(files.file("_samples.tsv"));
    CHECK(
        text ==
        "t_host_s\tt_device_s\ttrial\tpointer_id\ttool\tphase\tx_mm\ty_mm\tpressure\tforce_N\tdepth_mm\ttangential_N\t"
        "avatar_x_mm\tavatar_y_mm\tlag_mm\tdelay_ms\ttexture_mm\tsaturated\tft_source\tfootprint_mm\tcrease\tdrawn_"
        "depth_mm\n"
        "0.1\tn/a\t1\t0\tpen\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\t1\tn/a\tn/a\tn/a\tn/a\n");
    const Json json = read_json(files.file("_samples.json"));
    CHECK(json.size() == 22);
    CHECK(json["force_N"]["Units"] == "N");
}

TEST_CASE("sample log: a second run takes the next number, the first stays as it was") {
    const TemporaryFolder folder;
    const RunFiles first = next_run(folder.path(), "01");
    { SampleLog log(first); }
    const std::string before = read_text(first.file("_samples.tsv"));
    const RunFiles second = next_run(folder.path(), "01");
    CHECK(second.stem == "sub-01_task-palpation_run-02");
    { SampleLog log(second); }
    CHECK(read_text(first.file("_samples.tsv")) == before);
}
