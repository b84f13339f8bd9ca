#include "study/sample_log.h"

#include <cstdio>
#include <stdexcept>

#include "files/input_error.h"
#include "files/json.h"
#include "files/text.h"
#include "study/names.h"
#include "study/rows.h"

namespace palpa::study {

// One list gives the header, the explanation and every row.
template <class Visit>
void visit_fields(const SampleRow& r, Visit&& visit) {
    visit("t_host_s", r.t_host_s, "s", "arrival of the sample, host's steady clock");
    visit("t_device_s", r.t_device_s, "s", "time of the sample, device's or X server's clock");
    visit("trial", r.trial, "", "number of the trial");
    visit("pointer_id", r.pointer_id, "", "tells fingers and pens apart while they touch");
    visit("tool", r.tool, "", "pen, finger, mouse or keyboard");
    visit("phase", r.phase, "", "hover, down, move, up, cancel or ui");
    visit("x_mm", r.x_mm, "mm", "pen on the tissue, map's frame");
    visit("y_mm", r.y_mm, "mm", "pen on the tissue, map's frame");
    visit("pressure", r.pressure, "", "as reported, 0 to 1 of the device's range");
    visit("force_N", r.force_N, "N", "normal force after calibration and force_scale");
    visit("depth_mm", r.depth_mm, "mm", "indentation");
    visit("tangential_N", r.tangential_N, "N", "force of the tissue against the motion");
    visit("avatar_x_mm", r.avatar_x_mm, "mm", "avatar as shown, map's frame");
    visit("avatar_y_mm", r.avatar_y_mm, "mm", "avatar as shown, map's frame");
    visit("lag_mm", r.lag_mm, "mm", "distance from pen to avatar");
    visit("delay_ms", r.delay_ms, "ms", "delay of the avatar (law D)");
    visit("texture_mm", r.texture_mm, "mm", "how far the tissue's texture is dragged along with a finger");
    visit("saturated", r.saturated, "", "1: pressed deeper than the tissue is known");
    visit("ft_source", r.ft_source, "", "where the tangential force comes from: recorded, energy or none");
    visit("footprint_mm", r.footprint_mm, "mm", "radius of the ring that grows with depth; n/a without this cue");
    visit("crease", r.crease, "", "darkness of the crease, 0 to 1; n/a without this cue");
    visit("drawn_depth_mm", r.drawn_depth_mm, "mm", "depth as drawn; n/a where it is drawn as it is");
}

namespace {

void write_if_absent(const std::filesystem::path& path, const std::string& text) {
    if (!std::filesystem::exists(path)) files::write_text_atomically(path, text);
}

}  // namespace

void prepare_dataset(const std::filesystem::path& directory) {
    write_if_absent(directory / ".bidsignore",
                    "*_samples.tsv\n*_samples.json\n*_marks.tsv\n*_marks.json\n*_tactile.tsv\n*_tangible.tsv\n*_"
                    "settings.json\n*_performance."
                    "json\nstudy.json\nprotocol.json\nexclusions.*\nreplacements.*\nsub-*/now.json\n");
    write_if_absent(directory / "dataset_description.json",
                    files::json_text({{"Name", "Palpa"}, {"BIDSVersion", "1.8.0"}}));
}

void explain_samples_once(const std::filesystem::path& json) { write_if_absent(json, explanation_of<SampleRow>()); }

RunFiles next_run(const std::filesystem::path& directory, std::string_view participant, std::string_view task,
                  int first) {
    if (!is_code(participant)) throw files::bad_input("--participant", "", files::shown(participant), kCodeRule);
    RunFiles files;
    const std::string subject = "sub-" + std::string(participant);
    files.folder = directory / subject / "beh";
    std::error_code error;
    std::filesystem::create_directories(files.folder, error);
    if (error) throw std::runtime_error(files.folder.string() + ": cannot be created: " + error.message());
    prepare_dataset(directory);
    for (int run = first;; ++run) {
        char number[16];
        std::snprintf(number, sizeof number, "%02d", run);
        files.stem = subject + "_task-" + std::string(task) + "_run-" + number;
        const bool taken = std::filesystem::exists(files.file("_samples.tsv")) ||
                           std::filesystem::exists(files.file("_settings.json")) ||
                           std::filesystem::exists(files.file("_events.tsv"));
        if (!taken) return files;
    }
}

SampleLog::SampleLog(const RunFiles& files, bool sidecar) : file_(files.file("_samples.tsv")) {
    if (sidecar) files::write_text_atomically(files.file("_samples.json"), explanation_of<SampleRow>());
    file_.append(header_of<SampleRow>());
    constexpr std::size_t kLongestRow = 1024;
    row_.reserve(kLongestRow);
}

void SampleLog::write(const SampleRow& row) {
    line_of(row, row_);
    file_.append(row_);
}

}  // namespace palpa::study
