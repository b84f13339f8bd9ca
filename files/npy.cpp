#include "files/npy.h"

#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <type_traits>

#include "files/input_error.h"
#include "files/pieces.h"
#include "files/regular_file.h"

namespace palpa::files {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are read as they lie in the file");

constexpr std::string_view kNpyMagic("\x93NUMPY", 6);

struct Header {
    std::size_t from = 0;  // position of its text
    std::size_t length = 0;
    std::size_t data_offset() const { return from + length; }
};

// `start`: at least the first 12 bytes of a file of `file_bytes`, or all of it.
Header find_header(std::string_view start, std::size_t file_bytes, const std::string& file) {
    if (start.size() < 10 || start.substr(0, 6) != kNpyMagic) {
        throw bad_input(file, "", "no NumPy magic number", "an .npy file");
    }
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(start[i])); };
    const std::size_t version = byte(6);
    if (version != 1 && version != 2) {
        throw bad_input(file, "", "format version " + std::to_string(version), "version 1 or 2");
    }
    Header header{10, byte(8) + (byte(9) << 8)};
    if (version == 2) {
        if (start.size() < 12) throw bad_input(file, "", "a truncated header", "an .npy file");
        header.length += (byte(10) << 16) + (byte(11) << 24);
        header.from = 12;
    }
    if (header.length > file_bytes - header.from) {
        throw bad_input(
            file, "",
            "a header of " + std::to_string(header.length) + " bytes in a file of " + std::to_string(file_bytes),
            "a header that fits");
    }
    return header;
}

// Returns the text after "'key':" without leading blanks.
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
        if (error != std::errc())
            throw bad_input(file, "shape", shown(text.substr(0, close + 1)), "whole numbers >= 0");
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

template <class Value, class Out>
void take_values(const char* from, std::size_t n, Out* to) {
    for (std::size_t i = 0; i < n; ++i) {
        Value value;
        std::memcpy(&value, from + i * sizeof(Value), sizeof(Value));
        to[i] = static_cast<Out>(value);
    }
}

// What the header says of the array.
struct Layout {
    std::vector<std::size_t> shape;
    bool is_double = false;
    std::size_t count = 0;
    std::size_t value_bytes() const { return is_double ? 8 : 4; }
};

// Throws unless the array holds numbers that become `Out`.
template <class Out>
Layout layout_of(std::string_view text, std::size_t data_bytes, const std::string& file) {
    Layout layout;
    const auto rest = after_key(text, "descr", file);
    const auto type = rest.substr(0, rest.starts_with('\'') ? std::min(rest.find('\'', 1), rest.size() - 1) + 1 : 5);
    const std::string bare(type.size() > 2 && type.front() == '\'' ? type.substr(1, type.size() - 2) : type);
    if constexpr (std::is_same_v<Out, std::int32_t>) {
        if (type != "'<i4'") throw bad_input(file, "descr", shown(bare), "'<i4' (little-endian int32)");
    } else {
        layout.is_double = type == "'<f8'";
        if (!layout.is_double && type != "'<f4'") {
            throw bad_input(file, "descr", shown(bare), "'<f4' or '<f8' (little-endian float32 or float64)");
        }
    }
    if (after_key(text, "fortran_order", file).substr(0, 5) != "False") {
        throw bad_input(file, "fortran_order", "True",
                        "False (C order, as numpy.ascontiguousarray makes it before numpy.save)");
    }
    layout.shape = parse_shape(after_key(text, "shape", file), file);
    layout.count = count_of(layout.shape, file);
    const std::size_t wanted_bytes = layout.count * layout.value_bytes();
    if (data_bytes != wanted_bytes) {
        throw bad_input(file, "", std::to_string(data_bytes) + " bytes of data",
                        std::to_string(wanted_bytes) + " for the shape " + shape_text(layout.shape));
    }
    return layout;
}

void take_values(const Layout& layout, const char* from, std::size_t n, float* to) {
    layout.is_double ? take_values<double>(from, n, to) : take_values<float>(from, n, to);
}
void take_values(const Layout&, const char* from, std::size_t n, std::int32_t* to) {
    take_values<std::int32_t>(from, n, to);
}

// Array: NpyArray or NpyIntegers.
template <class Array>
Array parse_array(std::string_view bytes, const std::string& file) {
    using Out = typename decltype(Array::values)::value_type;
    const Header header = find_header(bytes, bytes.size(), file);
    const std::string_view data = bytes.substr(header.data_offset());
    const Layout layout = layout_of<Out>(bytes.substr(header.from, header.length), data.size(), file);
    Array array{layout.shape, std::vector<Out>(layout.count)};
    take_values(layout, data.data(), layout.count, array.values.data());
    return array;
}

// Does the same as parse_array(), but reads the file in parts.
template <class Array>
Array read_in_parts(const InputFile& in, const std::string& file) {
    const auto read = [&](std::size_t offset, char* to, std::size_t n) {
        if (in.read_at(offset, to, n) != n) throw InputError(file + ": cannot be read to its end");
    };
    std::string start(std::min<std::size_t>(in.bytes(), 12), '\0');
    read(0, start.data(), start.size());
    const Header header = find_header(start, in.bytes(), file);
    std::string text(header.length, '\0');
    read(header.from, text.data(), text.size());
    using Out = typename decltype(Array::values)::value_type;
    const Layout layout = layout_of<Out>(text, in.bytes() - header.data_offset(), file);
    Array array{layout.shape, std::vector<Out>(layout.count)};
    constexpr std::size_t kPart = 1 << 16;  // in numbers
    std::vector<char> part(std::min(kPart, layout.count) * layout.value_bytes());
    for (std::size_t at = 0; at < layout.count; at += kPart) {
        const std::size_t n = std::min(kPart, layout.count - at);
        read(header.data_offset() + at * layout.value_bytes(), part.data(), n * layout.value_bytes());
        take_values(layout, part.data(), n, &array.values[at]);
    }
    return array;
}

}  // namespace

std::string shape_text(const std::vector<std::size_t>& shape) {
    std::string out = "(";
    for (std::size_t i = 0; i < shape.size(); ++i) out += (i > 0 ? ", " : "") + std::to_string(shape[i]);
    return out + (shape.size() == 1 ? ",)" : ")");
}

NpyArray parse_npy(std::string_view bytes, const std::string& file) { return parse_array<NpyArray>(bytes, file); }
NpyIntegers parse_npy_integers(std::string_view bytes, const std::string& file) {
    return parse_array<NpyIntegers>(bytes, file);
}

NpyArray read_npy(const std::filesystem::path& path) { return read_in_parts<NpyArray>(InputFile(path), path.string()); }
NpyIntegers read_npy_integers(const std::filesystem::path& path) {
    return read_in_parts<NpyIntegers>(InputFile(path), path.string());
}

namespace {

// type: '<f4' or '<i4'
std::string header_of(const char* type, const std::vector<std::size_t>& shape) {
    std::string header =
        "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': " + shape_text(shape) + ", }";
    constexpr std::size_t kPreamble = 10;
    constexpr std::size_t kAlignment = 64;
    while ((kPreamble + header.size() + 1) % kAlignment != 0) header.push_back(' ');
    header.push_back('\n');

    std::string out(kNpyMagic);
    out.append({'\x01', '\x00', static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)});
    return out + header;
}

template <class Value>
std::string_view bytes_of(const std::vector<Value>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

}  // namespace

std::string npy_header(const std::vector<std::size_t>& shape) { return header_of("<f4", shape); }

std::string npy_bytes(const NpyArray& array) { return npy_header(array.shape).append(bytes_of(array.values)); }

void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
               const std::vector<float>& values) {
    write_pieces_atomically(path, {npy_header(shape), bytes_of(values)});
}

void write_npy_integers(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
                        const std::vector<std::int32_t>& values) {
    write_pieces_atomically(path, {header_of("<i4", shape), bytes_of(values)});
}

}  // namespace palpa::files
