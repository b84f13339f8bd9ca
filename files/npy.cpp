#include "files/npy.h"

#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are read as they lie in the file");

constexpr std::string_view kMagic("\x93NUMPY", 6);

struct Header {
    std::string_view text;
    std::size_t data_offset = 0;
};

Header find_header(std::string_view bytes, const std::string& file) {
    if (bytes.size() < 10 || bytes.substr(0, 6) != kMagic) {
        throw bad_input(file, "", "no NumPy magic number", "an .npy file");
    }
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
    const std::size_t version = byte(6);
    if (version != 1 && version != 2) {
        throw bad_input(file, "", "format version " + std::to_string(version), "version 1 or 2");
    }
    std::size_t offset = 10;
    std::size_t length = byte(8) + (byte(9) << 8);
    if (version == 2) {
        if (bytes.size() < 12) throw bad_input(file, "", "a truncated header", "an .npy file");
        length += (byte(10) << 16) + (byte(11) << 24);
        offset = 12;
    }
    if (length > bytes.size() - offset) {
        throw bad_input(file, "", "a header of " + std::to_string(length) + " bytes in a file of " +
                                      std::to_string(bytes.size()), "a header that fits");
    }
    return {bytes.substr(offset, length), offset + length};
}

// The text after "'key':", leading blanks removed.
std::string_view after_key(std::string_view header, std::string_view key, const std::string& file) {
    const auto at = header.find("'" + std::string(key) + "':");
    if (at == std::string_view::npos) throw bad_input(file, key, "nothing", "the key in the .npy header");
    auto rest = header.substr(at + key.size() + 3);
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    return rest;
}

std::vector<std::size_t> parse_shape(std::string_view text, const std::string& file) {
    const auto close = text.find(')');
    if (text.empty() || text.front() != '(' || close == std::string_view::npos) {
        throw bad_input(file, "shape", shown(text), "(n, ...)");
    }
    auto inside = text.substr(1, close - 1);
    std::vector<std::size_t> shape;
    while (true) {
        inside.remove_prefix(std::min(inside.find_first_not_of(" ,"), inside.size()));
        if (inside.empty()) return shape;
        std::size_t n = 0;
        const auto [end, error] = std::from_chars(inside.data(), inside.data() + inside.size(), n);
        if (error != std::errc()) throw bad_input(file, "shape", shown(text.substr(0, close + 1)), "whole numbers >= 0");
        shape.push_back(n);
        inside.remove_prefix(static_cast<std::size_t>(end - inside.data()));
    }
}

std::size_t count_of(const std::vector<std::size_t>& shape, const std::string& file) {
    std::size_t count = 1;
    for (const std::size_t n : shape) {
        if (n != 0 && count > (std::numeric_limits<std::size_t>::max() / 16) / n) {
            throw bad_input(file, "shape", shape_text(shape), "a size that fits into memory");
        }
        count *= n;
    }
    return count;
}

template <class Value>
std::vector<float> read_values(std::string_view data) {
    std::vector<float> out(data.size() / sizeof(Value));
    for (std::size_t i = 0; i < out.size(); ++i) {
        Value value;
        std::memcpy(&value, data.data() + i * sizeof(Value), sizeof(Value));
        out[i] = static_cast<float>(value);
    }
    return out;
}

}  // namespace

std::string shape_text(const std::vector<std::size_t>& shape) {
    std::string out = "(";
    for (std::size_t i = 0; i < shape.size(); ++i) out += (i > 0 ? ", " : "") + std::to_string(shape[i]);
    return out + (shape.size() == 1 ? ",)" : ")");
}

NpyArray parse_npy(std::string_view bytes, const std::string& file) {
    const Header header = find_header(bytes, file);
    const auto type = after_key(header.text, "descr", file).substr(0, 5);
    const bool is_double = type == "'<f8'";
    if (!is_double && type != "'<f4'") {
        throw bad_input(file, "descr", shown(type), "'<f4' or '<f8' (little-endian float32 or float64)");
    }
    if (after_key(header.text, "fortran_order", file).substr(0, 5) != "False") {
        throw bad_input(file, "fortran_order", "True", "False (C order)");
    }
    NpyArray array;
    array.shape = parse_shape(after_key(header.text, "shape", file), file);
    const std::size_t wanted_bytes = count_of(array.shape, file) * (is_double ? 8 : 4);
    const std::string_view data = bytes.substr(header.data_offset);
    if (data.size() != wanted_bytes) {
        throw bad_input(file, "", std::to_string(data.size()) + " bytes of data",
                        std::to_string(wanted_bytes) + " for the shape " + shape_text(array.shape));
    }
    array.values = is_double ? read_values<double>(data) : read_values<float>(data);
    return array;
}

NpyArray read_npy(const std::filesystem::path& path) { return parse_npy(read_text(path), path.string()); }

std::string npy_bytes(const NpyArray& array) {
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': " + shape_text(array.shape) + ", }";
    constexpr std::size_t kPreamble = 10;
    constexpr std::size_t kAlignment = 64;
    while ((kPreamble + header.size() + 1) % kAlignment != 0) header.push_back(' ');
    header.push_back('\n');

    std::string out(kMagic);
    out.append({'\x01', '\x00', static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)});
    out.append(header);
    const std::size_t offset = out.size();
    out.resize(offset + array.values.size() * sizeof(float));
    std::memcpy(out.data() + offset, array.values.data(), array.values.size() * sizeof(float));
    return out;
}

}  // namespace palpa
