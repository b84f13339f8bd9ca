// Measured curves of buttons.

#include "files/table.h"
#include "parts/button_file.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;

PALPA_FUZZ_ENTRY(curve)(const std::uint8_t* data, std::size_t size) {
    return fuzz::read_or_refuse([&] {
        files::Table table(std::string(fuzz::text_of(data, size)), "c.tsv", '\t');
        const mechanics::MeasuredSupport support = parts::read_curve(table);
        mechanics::Button button;
        button.travel_m = support.travel_m.back();
        button.support = support;
        if (!(button.travel_m < 1.0)) return;
        try {
            const mechanics::ButtonCurve curve = mechanics::press_button(button);
            if (!(curve.loss_J >= -1e-9)) fuzz::finding("a curve that makes energy");
        } catch (const std::exception& error) {
            fuzz::check_message(error.what());
        }
    });
}
