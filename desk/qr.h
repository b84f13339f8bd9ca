#pragma once

#include <string>

namespace palpa::desk {

// A QR code of the text as lines of block characters (UTF-8), two modules high each, with the quiet zone of four
// modules that readers need. Filled blocks are the light modules: right where letters are lighter than their ground, as
// on most terminals; `coloured` sets black on white by escape sequences instead of trusting in that. Throws
// std::runtime_error for what does not fit (about 2,900 bytes).
std::string qr_text(const std::string& text, bool coloured);

}  // namespace palpa::desk
