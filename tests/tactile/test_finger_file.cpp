#include <doctest/doctest.h>

#include "files/input_error.h"
#include "files/text.h"
#include "tactile/finger_file.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::test;

TEST_CASE("finger file: the shipped fingertip is the default, and says that it is assumed") {
    const std::filesystem::path file = std::filesystem::path(PALPA_SOURCE_DIR) / "assets/fingers/fingertip.json";
    const mechanics::PadLaw pad = tactile::read_pad_law(file);
    const mechanics::PadLaw otherwise;
    CHECK(pad.young_Pa == otherwise.young_Pa);
    CHECK(pad.rise_Pa_per_N == otherwise.rise_Pa_per_N);
    CHECK(pad.poisson == otherwise.poisson);
    CHECK(files::read_text(file).find("\"assumed\": true") != std::string::npos);
}

TEST_CASE("finger file: wrong numbers and unknown keys are refused by file and key") {
    TemporaryFolder folder;
    const auto refused = [&](const std::string& text, const std::string& key) {
        files::write_text_atomically(folder / "pad.json", text);
        try {
            tactile::read_pad_law(folder / "pad.json");
        } catch (const files::InputError& error) {
            const std::string message = error.what();
            return message.find("pad.json") != std::string::npos && message.find(key) != std::string::npos;
        }
        return false;
    };
    CHECK(refused(R"({"name": "x", "young_Pa": -1, "rise_Pa_per_N": 0, "poisson": 0.5, "source": "s"})", "young_Pa"));
    CHECK(refused(R"({"name": "x", "young_Pa": 1, "rise_Pa_per_N": 0, "poisson": 0.6, "source": "s"})", "poisson"));
    CHECK(refused(R"({"name": "x", "young_Pa": 1, "rise_Pa_per_N": 0, "poisson": 0.5})", "source"));
    CHECK(refused(R"({"name": "x", "young_kPa": 1, "rise_Pa_per_N": 0, "poisson": 0.5, "source": "s"})", "young_kPa"));
}
