#include "desk/qr.h"

#include <cerrno>
#include <cstring>
#include <memory>
#include <qrencode.h>
#include <stdexcept>

namespace palpa::desk {
namespace {

constexpr int kQuiet = 4;

}  // namespace

std::string qr_text(const std::string& text, bool coloured) {
    const std::unique_ptr<QRcode, decltype(&QRcode_free)> code(QRcode_encodeString8bit(text.c_str(), 0, QR_ECLEVEL_L),
                                                               &QRcode_free);
    if (!code) throw std::runtime_error(std::string("no QR code can be made: ") + std::strerror(errno));
    const int n = code->width;
    const auto dark = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < n && y < n && (code->data[y * n + x] & 1) != 0;
    };
    std::string out;
    for (int y = -kQuiet; y < n + kQuiet; y += 2) {
        if (coloured) out += "\033[40;97m";
        for (int x = -kQuiet; x < n + kQuiet; ++x) {
            const bool upper = !dark(x, y);
            // below the last row of an odd number of rows the quiet zone has ended
            const bool lower = y + 1 < n + kQuiet && !dark(x, y + 1);
            out += upper ? (lower ? "\u2588" : "\u2580") : (lower ? "\u2584" : " ");
        }
        out += coloured ? "\033[0m\n" : "\n";
    }
    return out;
}

}  // namespace palpa::desk
