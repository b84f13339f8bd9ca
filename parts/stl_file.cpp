#include "parts/stl_file.h"

#include <cctype>
#include <cmath>
#include <cstring>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/error.h"

namespace palpa::parts {
namespace {

using mechanics::Triangle;

constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

std::uint32_t uint32_at(std::string_view bytes, std::size_t at) {
    std::uint32_t out = 0;
    for (std::size_t i = 0; i < 4; ++i) out |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return out;
}

void check_triangles(std::size_t n, const std::string& file) {
    if (n == 0 || n > mechanics::kMostTriangles) {
        throw files::bad_input(file, "", std::to_string(n) + " triangles",
                               "1 to " + std::to_string(mechanics::kMostTriangles));
    }
}

std::vector<Triangle> parse_binary(std::string_view bytes, const std::string& file, double unit_m) {
    const std::size_t n = uint32_at(bytes, 80);
    check_triangles(n, file);
    std::vector<Triangle> out(n);
    for (std::size_t t = 0; t < n; ++t) {
        for (std::size_t i = 0; i < 9; ++i) {
            // the normal's 12 bytes are passed over
            const std::uint32_t bits = uint32_at(bytes, kStlHeader + kStlTriangle * t + 12 + 4 * i);
            float single = 0.0F;
            std::memcpy(&single, &bits, sizeof single);  // the browser's library has no std::bit_cast
            const auto value = static_cast<double>(single);
            if (!std::isfinite(value)) {
                throw files::bad_input(file, "triangle " + std::to_string(t + 1), "a number that is not finite",
                                       "coordinates");
            }
            out[t][i / 3][i % 3] = unit_m * value;
        }
    }
    return out;
}

// Words of a text, one after the other.
class StlWords {
  public:
    StlWords(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    // "" at the end
    std::string_view next() {
        while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n' ? 1 : 0;
        const std::size_t from = at_;
        while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
        return text_.substr(from, at_ - from);
    }
    void skip_line() {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    }
    void expect(std::string_view word) {
        const std::string_view found = next();
        if (!same(found, word)) fail(found, "'" + std::string(word) + "'");
    }
    double number() {
        const std::string_view found = next();
        double value = 0.0;
        if (!files::parse_number(found, value) || !std::isfinite(value)) fail(found, "a number");
        return value;
    }
    [[noreturn]] void fail(std::string_view found, const std::string& expected) const {
        throw files::bad_input(file_, "line " + std::to_string(line_),
                               found.empty() ? "the end of the file" : files::shown(found), expected);
    }
    static bool same(std::string_view found, std::string_view lower) {
        if (found.size() != lower.size()) return false;
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (std::tolower(static_cast<unsigned char>(found[i])) != lower[i]) return false;
        }
        return true;
    }

  private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0;
    int line_ = 1;
};

Triangle read_facet(StlWords& words, double unit_m) {
    Triangle out{};
    words.expect("normal");
    for (int i = 0; i < 3; ++i) words.next();  // some programs write nan here
    words.expect("outer");
    words.expect("loop");
    for (auto& corner : out) {
        words.expect("vertex");
        for (double& c : corner) c = unit_m * words.number();
    }
    words.expect("endloop");
    words.expect("endfacet");
    return out;
}

std::vector<Triangle> parse_text(std::string_view text, const std::string& file, double unit_m) {
    std::vector<Triangle> out;
    StlWords words(text, file);
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (!StlWords::same(word, "solid")) words.fail(word, "'solid'");
        words.skip_line();
        while (true) {
            word = words.next();
            if (StlWords::same(word, "endsolid")) break;
            if (!StlWords::same(word, "facet")) words.fail(word, "'facet' or 'endsolid'");
            out.push_back(read_facet(words, unit_m));
        }
        words.skip_line();
    }
    check_triangles(out.size(), file);
    return out;
}

bool begins_with_solid(std::string_view bytes) { return StlWords::same(bytes.substr(0, 5), "solid"); }

bool is_text(std::string_view bytes) {
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 && c != '\n' && c != '\r' && c != '\t') return false;
    }
    return true;
}

}  // namespace

std::vector<Triangle> parse_stl(std::string_view bytes, const std::string& file, double unit_m) {
    const bool counted = bytes.size() >= kStlHeader;
    const std::size_t wanted = counted ? kStlHeader + kStlTriangle * std::size_t{uint32_at(bytes, 80)} : 0;
    if (counted && bytes.size() == wanted) return parse_binary(bytes, file, unit_m);
    const bool solid = begins_with_solid(bytes);
    if (solid && is_text(bytes)) return parse_text(bytes, file, unit_m);
    const std::string size = std::to_string(bytes.size()) + " bytes";
    if (!counted) throw files::bad_input(file, "", size, "an STL file: 'solid' and text, or at least 84 bytes");
    throw files::bad_input(file, "",
                           (solid ? "a binary file that begins with 'solid', of " : "a binary file of ") + size,
                           std::to_string(wanted) + " bytes, which its count of " +
                               std::to_string(uint32_at(bytes, 80)) + " triangles takes");
}

mechanics::TriangleSolid solid_of(std::vector<Triangle> triangles, const std::string& file) {
    mechanics::TriangleSolid solid;
    try {
        solid = mechanics::make_solid(std::move(triangles));
    } catch (const mechanics::MeshError& error) {
        throw files::InputError(file + ": " + error.what());
    }
    const mechanics::SolidCheck check = check_solid(solid);
    if (check.open_share > 0.0) {
        throw files::bad_input(file, "",
                               "holes: along " + files::short_number(100.0 * check.open_share) +
                                   " % of the lines the three axes disagree; " + std::to_string(check.open_edges) +
                                   " edges of triangles have no partner",
                               "a closed surface");
    }
    if (check.turned_share > 0.0 || !(check.volume_m3 > 0.0)) {
        const bool all = check.volume_m3 < 0.0;
        throw files::bad_input(file, "",
                               check.turned_share > 0.0
                                   ? std::string(all ? "inside out" : "partly inside out") + ": along " +
                                         files::short_number(100.0 * check.turned_share) +
                                         " % of the lines triangles face inwards"
                                   : "no volume",
                               "triangles whose corners run counter-clockwise, seen from outside");
    }
    return solid;
}

mechanics::TriangleSolid read_stl(const std::filesystem::path& path, double unit_m,
                                  const std::array<double, 3>& offset_m) {
    std::vector<Triangle> triangles = parse_stl(files::read_text(path), path.string(), unit_m);
    for (Triangle& triangle : triangles) {
        for (auto& corner : triangle) {
            for (std::size_t c = 0; c < 3; ++c) corner[c] += offset_m[c];
        }
    }
    return solid_of(std::move(triangles), path.string());
}

}  // namespace palpa::parts
