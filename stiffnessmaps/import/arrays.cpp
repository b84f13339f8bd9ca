#include "stiffnessmaps/import/arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "stiffnessmaps/import/apart.h"
#include "stiffnessmaps/import/columns.h"

namespace palpa::stiffnessmaps {
namespace {

namespace fs = std::filesystem;

std::string first_bytes(const fs::path& path, std::size_t n) {
    std::string bytes(n, '\0');
    bytes.resize(files::InputFile(path).read_at(0, bytes.data(), n));
    return bytes;
}

std::string_view without_blanks(std::string_view text) {
    const auto blank = [](char c) { return c == ' ' || c == '\r' || c == '\t'; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

// Returns comma, tab or semicolon, or a blank if the line has none of these.
char matrix_separator(std::string_view line) {
    const char separator = separator_of(line);
    return line.find(separator) == std::string_view::npos ? ' ' : separator;
}

// Calls visit(field) for each field of a line; a run of blanks is one separator. Returns false as soon as visit does.
template <class Visit>
bool visit_fields(std::string_view line, char separator, Visit visit) {
    line = separator == '\t' ? line : without_blanks(line);
    while (true) {
        const auto end = line.find(separator);
        if (!visit(without_blanks(line.substr(0, end)))) return false;
        if (end == std::string_view::npos) return true;
        line.remove_prefix(end + 1);
        if (separator == ' ') line = without_blanks(line);
    }
}

bool parse_cell(std::string_view text, float& out) {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!text.empty() && text != "n/a" && !files::parse_number(text, value)) return false;
    if (std::isinf(value)) return false;
    out = static_cast<float>(value);
    return true;
}

bool is_number_line(std::string_view line) {
    bool any = false;
    const bool all = visit_fields(line, matrix_separator(line), [&](std::string_view field) {
        float value = 0.0f;
        if (!parse_cell(field, value)) return false;
        any = any || !field.empty();
        return true;
    });
    return all && any;
}

}  // namespace

std::size_t check_shape(const std::vector<std::size_t>& shape, std::size_t value_bytes, std::size_t stored_bytes,
                        bool packed, const std::string& file) {
    if (shape.size() < 2 || shape.size() > 3)
        throw files::bad_input(file, "shape", files::shape_text(shape), "two or three dimensions");
    constexpr double kMostPacked = 1032.0;
    double n = 1.0;
    for (const std::size_t d : shape) n *= static_cast<double>(d);
    if (n == 0.0) throw files::bad_input(file, "shape", files::shape_text(shape), "at least one number");
    if (n > static_cast<double>(kMostNumbers))
        throw files::bad_input(file, "shape", files::shape_text(shape), "at most 20 million numbers");
    const double can = static_cast<double>(stored_bytes) * (packed ? kMostPacked : 1.0);
    if (n * static_cast<double>(value_bytes) > can) {
        throw files::bad_input(
            file, "shape", files::shape_text(shape),
            "numbers that fit into its " + std::to_string(stored_bytes) + " bytes (is the file whole?)");
    }
    return static_cast<std::size_t>(n);
}

std::optional<ArrayKind> array_kind(const fs::path& path) {
    constexpr std::size_t kEnough = 1 << 16;
    const std::string bytes = first_bytes(path, kEnough);
    const auto starts = [&](std::string_view magic, std::size_t at = 0) {
        return bytes.compare(at < bytes.size() ? at : bytes.size(), magic.size(), magic) == 0;
    };
    const std::string_view hdf5("\x89HDF\r\n\x1a\n", 8);
    if (starts("\x93NUMPY")) return ArrayKind::npy;
    if (starts("MATLAB 5.0")) return ArrayKind::matlab;
    for (const std::size_t at : {0u, 512u, 1024u, 2048u, 4096u, 8192u}) {
        if (starts(hdf5, at)) return ArrayKind::hdf5;
    }
    if (starts("\x89PNG\r\n\x1a\n")) return ArrayKind::png;
    for (const std::string_view tiff : {std::string_view("II*\0", 4), std::string_view("MM\0*", 4),
                                        std::string_view("II+\0", 4), std::string_view("MM\0+", 4)}) {
        if (starts(tiff)) return ArrayKind::tiff;
    }
    std::string_view text = bytes;
    if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
    const std::string_view line = text.substr(0, text.find('\n'));
    if (line.find('\0') != std::string_view::npos) return std::nullopt;
    if (line.size() == bytes.size() && bytes.size() == kEnough) return std::nullopt;  // no end of a line
    if (is_number_line(line)) return ArrayKind::text;
    return std::nullopt;
}

files::NpyArray parse_number_matrix(std::string_view text, const std::string& file) {
    if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
    const char separator = matrix_separator(text.substr(0, text.find('\n')));
    files::NpyArray array;
    std::size_t columns = 0;
    std::size_t rows = 0;
    std::size_t line_number = 0;
    while (!text.empty()) {
        const auto end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++line_number;
        if (without_blanks(line).empty()) continue;
        std::size_t n = 0;
        visit_fields(line, separator, [&](std::string_view field) {
            float value = 0.0f;
            if (!parse_cell(field, value)) {
                throw files::bad_input(file,
                                       "line " + std::to_string(line_number) + ", number " + std::to_string(n + 1),
                                       files::shown(field), "a finite number or n/a");
            }
            array.values.push_back(value);
            ++n;
            return true;
        });
        if (rows == 0) columns = n;
        if (n != columns) {
            throw files::bad_input(file, "line " + std::to_string(line_number), std::to_string(n) + " numbers",
                                   std::to_string(columns) + " as in the first line");
        }
        ++rows;
    }
    array.shape = {rows, columns};
    check_shape(array.shape, 1, array.values.size(), false, file);
    return array;
}

files::NpyArray read_array(const fs::path& path, const std::string& dataset) {
    const std::string file = path.string();
    const auto kind = array_kind(path);
    if (!kind)
        throw files::bad_input(file, "", "another kind of file",
                               "an array: .npy, rows of numbers, MATLAB, HDF5, PNG or TIFF");
    if (!dataset.empty() && *kind != ArrayKind::matlab && *kind != ArrayKind::hdf5)
        throw files::bad_input("--dataset", "", files::shown(dataset) + " for " + file + ", which holds one array",
                               "a MATLAB or HDF5 file");
    files::NpyArray array;
    switch (*kind) {
        case ArrayKind::npy:
            array = files::read_npy(path);
            break;
        case ArrayKind::text:
            array = parse_number_matrix(files::read_text(path), file);
            break;
        case ArrayKind::matlab:
            array = read_apart(file, "the MATLAB reader", [&] { return read_matlab(path, dataset); });
            break;
        case ArrayKind::hdf5:
            array = read_apart(file, "the HDF5 library", [&] { return read_hdf5(path, dataset); });
            break;
        case ArrayKind::png:
            array = read_apart(file, "the PNG library", [&] { return read_png(path); });
            break;
        case ArrayKind::tiff:
            array = read_apart(file, "the TIFF library", [&] { return read_tiff(path); });
            break;
    }
    check_shape(array.shape, 1, array.values.size(), false, file);
    return array;
}

}  // namespace palpa::stiffnessmaps
