#include "tactile/finger_file.h"

#include "files/json.h"

namespace palpa::tactile {

mechanics::PadLaw read_pad_law(const std::filesystem::path& path) {
    const files::Json root = files::read_json(path);
    files::JsonReader json(root, path.string());
    json.only({"name", "young_Pa", "rise_Pa_per_N", "poisson", "assumed", "source"});
    json.text("name");
    json.text("source");
    json.boolean("assumed", false);
    mechanics::PadLaw pad;
    pad.young_Pa = json.number("young_Pa", files::kPositive);
    pad.rise_Pa_per_N = json.number("rise_Pa_per_N", files::kNotNegative);
    pad.poisson = json.number("poisson", {0.0, 0.5});
    json.finish();
    return pad;
}

}  // namespace palpa::tactile
