#include "study/bundle_run.h"

#include <algorithm>
#include <vector>

#include "files/json.h"
#include "files/sha256.h"
#include "files/text.h"

namespace palpa {

std::string bundle_text(const RunFiles& run) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(run.folder)) {
        const std::string name = entry.path().filename().string();
        if (name.rfind(run.stem + "_", 0) == 0) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    const std::string subject = run.stem.substr(0, run.stem.find('_'));
    Json files = Json::array();
    for (const std::string& name : names) {
        const std::string text = read_text(run.folder / name);
        files.push_back({{"name", subject + "/beh/" + name}, {"sha256", sha256_hex(text)}, {"text", text}});
    }
    return json_text({{"palpa_bundle", 1}, {"files", files}});
}

}  // namespace palpa
