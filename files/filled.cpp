#include "files/filled.h"

#include <cassert>

namespace palpa::files {

std::string filled(std::string_view pattern, std::initializer_list<std::string_view> values) {
    std::string out;
    const std::string_view* value = values.begin();
    for (std::size_t at = 0;;) {
        const std::size_t gap = pattern.find("{}", at);
        out += pattern.substr(at, gap - at);
        if (gap == std::string_view::npos) break;
        assert(value != values.end());
        out += *value++;
        at = gap + 2;
    }
    assert(value == values.end());
    return out;
}

}  // namespace palpa::files
