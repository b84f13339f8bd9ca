#include "app/screens/doing.h"

namespace palpa::app {

const bool* menu_of(const Doing& doing) {
    if (const auto* palpating = std::get_if<Palpating>(&doing)) return &palpating->menu;
    if (const auto* reviewing = std::get_if<Reviewing>(&doing)) return &reviewing->menu;
    return nullptr;
}

bool* menu_of(Doing& doing) {
    if (auto* palpating = std::get_if<Palpating>(&doing)) return &palpating->menu;
    if (auto* reviewing = std::get_if<Reviewing>(&doing)) return &reviewing->menu;
    return nullptr;
}

bool is_guided(const Doing& doing) {
    if (const auto* palpating = std::get_if<Palpating>(&doing)) return palpating->guided;
    const auto* reviewing = std::get_if<Reviewing>(&doing);
    return reviewing != nullptr && reviewing->guided;
}

bool palpates(const Doing& doing) {
    const StudyRun* study = study_of(doing);
    return study != nullptr ? trial_goes_on(*study) : std::holds_alternative<Palpating>(doing);
}

bool keys_move_indenter(const Doing& doing) {
    const bool* menu = menu_of(doing);
    if (menu != nullptr && *menu) return false;
    return palpates(doing) || std::holds_alternative<CheckingDevices>(doing);
}

}  // namespace palpa::app
