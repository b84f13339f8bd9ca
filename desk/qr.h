#pragma once

#include <string>

namespace palpa::desk {

// Returns a QR code of the text as lines of block characters (UTF-8), each two modules high, with the quiet zone of four
// modules that readers need. Filled blocks are the light modules, which is right where letters are lighter than their
// background, as on most terminals; `coloured` sets black on white by escape sequences instead. Throws
// std::runtime_error for a text that does not fit (about 2,900 bytes).
std::string qr_text(const std::string& text, bool coloured);

}  // namespace palpa::desk
