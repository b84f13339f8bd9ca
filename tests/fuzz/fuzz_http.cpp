// Heads of HTTP requests, and the file that the path in the first line names.

#include "desk/request_head.h"
#include "desk/static_files.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::desk;

namespace {

// Of "GET /a/b HTTP/1.1".
std::string_view target_in(std::string_view head) {
    const auto before = head.find(' ');
    if (before == std::string_view::npos) return head;
    head.remove_prefix(before + 1);
    return head.substr(0, head.find(' '));
}

}  // namespace

PALPA_FUZZ_ENTRY(http)(const std::uint8_t* data, std::size_t size) {
    const std::string_view head = fuzz::text_of(data, size);
    const CheckedHead checked = check_head(head);
    if (checked.refused == 0 && check_head(checked.text).refused != 0)
        fuzz::finding("a head that is refused when it is checked again");
    if (checked.refused != 0 && (checked.refused < 400 || checked.refused > 505))
        fuzz::finding("no status of a refusal");
    const auto names = names_of_path(target_in(head));
    if (!names) return 0;
    for (const std::string& name : *names) {
        const bool plain = !name.empty() && name.front() != '.' &&
                           name.find_first_of(std::string_view("/\\\0", 3)) == std::string::npos;
        if (!plain) fuzz::finding("a name that leads elsewhere");
        mime_type(name);
    }
    return 0;
}
