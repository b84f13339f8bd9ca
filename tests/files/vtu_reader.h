#pragma once
// Reads a .vtu back, by the format's description and none of the writer's code: tags, attributes, base64,
// lengths. Throws std::runtime_error for XML that does not nest and arrays of a wrong length.

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpa::test {

struct VtuRead {
    struct Array {
        std::string type;
        int components = 1;
        std::string bytes;
    };
    std::size_t points = 0;
    std::size_t cells = 0;
    std::vector<std::string> sections;
    std::map<std::string, Array> arrays;

    template <class Value>
    std::vector<Value> as(const std::string& name) const {
        const Array& array = arrays.at(name);
        const char* const wanted = sizeof(Value) == 1 ? "UInt8" : std::is_floating_point_v<Value> ? "Float64" : "Int64";
        if (array.type != wanted || array.bytes.size() % sizeof(Value) != 0) throw std::runtime_error(name + ": type");
        std::vector<Value> out(array.bytes.size() / sizeof(Value));
        if (!out.empty()) std::memcpy(out.data(), array.bytes.data(), array.bytes.size());
        return out;
    }
    std::vector<double> doubles(const std::string& name) const { return as<double>(name); }
    int components(const std::string& name) const { return arrays.at(name).components; }
};

inline std::string from_base64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    std::uint32_t bits = 0;
    int have = 0;
    for (const char c : text) {
        if (c == '=' || c == '\n' || c == ' ') continue;
        const auto digit = digits.find(c);
        if (digit == std::string::npos) throw std::runtime_error("not base64");
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        have += 6;
        if (have < 8) continue;
        have -= 8;
        out.push_back(static_cast<char>(bits >> have & 255u));
    }
    return out;
}

inline std::string attribute(const std::string& tag, const std::string& name) {
    const auto at = tag.find(" " + name + "=\"");
    if (at == std::string::npos) throw std::runtime_error(tag + ": no " + name);
    const auto first = at + name.size() + 3;
    return tag.substr(first, tag.find('"', first) - first);
}

inline VtuRead read_vtu_text(const std::string& text) {
    VtuRead out;
    std::vector<std::string> open;
    for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
        const auto end = text.find('>', at);
        const std::string tag = text.substr(at + 1, end - at - 1);
        if (tag.front() == '?') continue;
        const std::string name = tag.substr(0, tag.find(' '));
        if (name.front() == '/') {
            if (open.empty() || open.back() != name.substr(1)) throw std::runtime_error(name + " closes nothing");
            open.pop_back();
            continue;
        }
        if (name == "VTKFile" &&
            (attribute(tag, "byte_order") != "LittleEndian" || attribute(tag, "header_type") != "UInt64" ||
             attribute(tag, "type") != "UnstructuredGrid")) {
            throw std::runtime_error("VTKFile");
        }
        if (name == "Piece") {
            out.points = std::stoul(attribute(tag, "NumberOfPoints"));
            out.cells = std::stoul(attribute(tag, "NumberOfCells"));
        }
        if (name == "DataArray") {
            if (attribute(tag, "format") != "binary") throw std::runtime_error("format");
            const std::string bytes = from_base64(text.substr(end + 1, text.find('<', end) - end - 1));
            std::uint64_t length = 0;
            if (bytes.size() < sizeof length) throw std::runtime_error("no length");
            std::memcpy(&length, bytes.data(), sizeof length);
            if (length != bytes.size() - sizeof length) throw std::runtime_error(tag + ": length");
            out.arrays[attribute(tag, "Name")] = {
                attribute(tag, "type"), std::stoi(attribute(tag, "NumberOfComponents")), bytes.substr(sizeof length)};
        } else if (open.size() == 3) {
            out.sections.push_back(name);
        }
        open.push_back(name);
    }
    if (!open.empty()) throw std::runtime_error(open.back() + " stays open");
    return out;
}

}  // namespace palpa::test
