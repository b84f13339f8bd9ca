#pragma once
// The text of a number in a log, in half the instructions of std::to_chars: a log of ten minutes at 1,000 Hz holds six
// million numbers.

namespace palpa::files {

// Characters that write_shortest() may touch, far more than the text has.
inline constexpr int kShortestDecimal = 48;

// Writes the shortest decimal that reads back as `value`, the nearest of these to it, exactly as std::to_chars does, and
// returns the text's end. Returns nullptr for what it leaves to std::to_chars: what is shorter with an exponent or not
// finite, and all from 1e15 on.
char* write_shortest(double value, char* out);

}  // namespace palpa::files
