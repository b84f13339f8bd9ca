// Reads grey images by libpng and libtiff: one number per pixel, not scaled.

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <png.h>
#include <tiffio.h>

#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "stiffnessmaps/import/arrays.h"

namespace palpa::stiffnessmaps {
namespace {

struct PngSource {
    std::string_view rest;
    char failed[100];
};

void give_bytes(png_structp png, png_bytep out, std::size_t n) {
    auto& source = *static_cast<PngSource*>(png_get_io_ptr(png));
    if (n > source.rest.size()) png_error(png, "an end before the image's");
    std::memcpy(out, source.rest.data(), n);
    source.rest.remove_prefix(n);
}

void note_failure(png_structp png, png_const_charp message) {
    auto& source = *static_cast<PngSource*>(png_get_error_ptr(png));
    std::snprintf(source.failed, sizeof source.failed, "%s", message);
    png_longjmp(png, 1);
}

void keep_quiet(png_structp, png_const_charp) {}

// Reads the rows as they are stored, most significant byte first, without gamma. Returns what went wrong, or "".
std::string decode_png(const std::string& bytes, std::size_t line, std::vector<unsigned char>& rows) {
    PngSource source{bytes, "something else"};
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, note_failure, keep_quiet);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    if (info == nullptr) return "no memory";
    std::vector<png_bytep> starts;
    for (std::size_t at = 0; at < rows.size(); at += line) starts.push_back(rows.data() + at);
    if (setjmp(png_jmpbuf(png)) != 0) {  // longjmp comes from note_failure
        png_destroy_read_struct(&png, &info, nullptr);
        return source.failed;
    }
    png_set_read_fn(png, &source, give_bytes);
    png_read_info(png, info);
    png_set_interlace_handling(png);
    if (png_get_rowbytes(png, info) != line || png_get_image_height(png, info) != starts.size())
        png_error(png, "another size than its header's");
    png_read_image(png, starts.data());
    png_read_end(png, nullptr);
    png_destroy_read_struct(&png, &info, nullptr);
    return "";
}

}  // namespace

files::NpyArray read_png(const std::filesystem::path& path) {
    const std::string file = path.string();
    const std::string bytes = files::read_text(path);
    constexpr std::size_t kHeader = 33;  // signature and IHDR
    if (bytes.size() < kHeader || std::string_view(bytes).substr(12, 4) != "IHDR")
        throw files::bad_input(file, "", "no PNG header", "a whole image");
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
    const auto big_endian = [&](std::size_t i) {
        return byte(i) << 24 | byte(i + 1) << 16 | byte(i + 2) << 8 | byte(i + 3);
    };
    if (byte(25) != 0 || (byte(24) != 8 && byte(24) != 16)) {
        throw files::bad_input(file, "", "an image with colours, transparency or under 8 bits",
                               "grey values of 8 or 16 bits");
    }
    const bool wide = byte(24) == 16;
    files::NpyArray array;
    array.shape = {big_endian(20), big_endian(16)};
    const std::size_t n = check_shape(array.shape, wide ? 2 : 1, bytes.size(), true, file);

    array.values.resize(n);
    const std::size_t line = array.shape[1] * (wide ? 2 : 1);
    std::vector<unsigned char> rows(n * (wide ? 2 : 1));
    const std::string failed = decode_png(bytes, line, rows);
    if (!failed.empty()) throw files::bad_input(file, "", failed, "a whole image");
    for (std::size_t i = 0; i < n; ++i) {
        array.values[i] = wide ? static_cast<float>(rows[2 * i] << 8 | rows[2 * i + 1]) : static_cast<float>(rows[i]);
    }
    return array;
}

namespace {

struct CloseTiff {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

// How the numbers of a page are stored.
struct Format {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint16_t bits = 0;
    std::uint16_t kind = SAMPLEFORMAT_UINT;
    bool packed = true;
    std::size_t bytes() const { return bits / 8u; }
};

Format format_of(TIFF* tiff, const std::string& file) {
    Format f;
    std::uint16_t samples = 1;
    std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &f.width);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &f.height);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &f.bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &f.kind);
    TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
    std::uint16_t compression = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
    f.packed = compression != COMPRESSION_NONE;
    const bool whole = f.kind == SAMPLEFORMAT_UINT || f.kind == SAMPLEFORMAT_INT;
    const bool known =
        (whole && (f.bits == 8 || f.bits == 16 || f.bits == 32)) || (f.kind == SAMPLEFORMAT_IEEEFP && f.bits == 32);
    if (samples != 1 || !known || photometric != PHOTOMETRIC_MINISBLACK) {
        throw files::bad_input(file, "",
                               std::to_string(samples) + " numbers of " + std::to_string(f.bits) +
                                   " bits a pixel, or another meaning of them",
                               "grey values of 8, 16 or 32 bits, black the smallest");
    }
    return f;
}

template <class Value>
float taken(const unsigned char* at) {
    Value value;
    std::memcpy(&value, at, sizeof(Value));
    return static_cast<float>(value);
}

float number_at(const Format& f, const unsigned char* at) {
    const bool sign = f.kind == SAMPLEFORMAT_INT;
    switch (f.bits) {
        case 8:
            return sign ? taken<std::int8_t>(at) : taken<std::uint8_t>(at);
        case 16:
            return sign ? taken<std::int16_t>(at) : taken<std::uint16_t>(at);
        default:
            return f.kind == SAMPLEFORMAT_IEEEFP ? taken<float>(at)
                   : sign                        ? taken<std::int32_t>(at)
                                                 : taken<std::uint32_t>(at);
    }
}

void read_strips(TIFF* tiff, const Format& f, std::size_t offset, files::NpyArray& array, const std::string& file) {
    const std::size_t line = f.width * f.bytes();
    if (TIFFScanlineSize64(tiff) != line) throw files::bad_input(file, "", "lines of another length", "a whole image");
    std::vector<unsigned char> row(line);
    for (std::uint32_t y = 0; y < f.height; ++y) {
        if (TIFFReadScanline(tiff, row.data(), y, 0) != 1)
            throw files::bad_input(file, "row " + std::to_string(y), "nothing that can be read", "a whole image");
        for (std::size_t x = 0; x < f.width; ++x)
            array.values[offset + y * std::size_t{f.width} + x] = number_at(f, &row[x * f.bytes()]);
    }
}

void read_tiles(TIFF* tiff, const Format& f, std::size_t stored_bytes, std::size_t offset, files::NpyArray& array,
                const std::string& file) {
    std::uint32_t wide = 0;
    std::uint32_t high = 0;
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &wide);
    TIFFGetField(tiff, TIFFTAG_TILELENGTH, &high);
    check_shape({high, wide}, f.bytes(), stored_bytes, true, file);
    std::vector<unsigned char> tile(std::size_t{wide} * high * f.bytes());
    if (TIFFTileSize64(tiff) != tile.size()) throw files::bad_input(file, "", "tiles of another size", "a whole image");
    for (std::uint32_t y = 0; y < f.height; y += high) {
        for (std::uint32_t x = 0; x < f.width; x += wide) {
            if (TIFFReadTile(tiff, tile.data(), x, y, 0, 0) < 0)
                throw files::bad_input(file, "", "a tile that cannot be read", "a whole image");
            for (std::uint32_t b = 0; b < high && y + b < f.height; ++b) {
                for (std::uint32_t a = 0; a < wide && x + a < f.width; ++a) {
                    array.values[offset + (y + b) * std::size_t{f.width} + x + a] =
                        number_at(f, &tile[(b * std::size_t{wide} + a) * f.bytes()]);
                }
            }
        }
    }
}

}  // namespace

files::NpyArray read_tiff(const std::filesystem::path& path) {
    const std::string file = path.string();
    files::check_input(path);
    TIFFSetErrorHandler(nullptr);
    TIFFSetWarningHandler(nullptr);
    const std::unique_ptr<TIFF, CloseTiff> tiff(TIFFOpen(file.c_str(), "rm"));
    if (!tiff) throw files::bad_input(file, "", "no TIFF file that can be opened", "a whole image");
    const std::size_t stored = std::filesystem::file_size(path);
    files::NpyArray array;
    Format first;
    std::size_t pages = 0;
    constexpr std::size_t kMostPages = 1000;
    do {
        const Format f = format_of(tiff.get(), file);
        if (pages == 0) first = f;
        if (f.width != first.width || f.height != first.height)
            throw files::bad_input(file, "", "pages of several sizes", "one size");
        if (++pages > kMostPages) throw files::bad_input(file, "", "more than 1000 pages", "fewer");
        const std::size_t n = check_shape({f.height, f.width}, f.bytes(), stored, f.packed, file);
        check_shape({pages, f.height, f.width}, f.bytes(), stored, f.packed, file);
        const std::size_t offset = array.values.size();
        array.values.resize(offset + n);
        if (TIFFIsTiled(tiff.get()) != 0) {
            read_tiles(tiff.get(), f, stored, offset, array, file);
        } else {
            read_strips(tiff.get(), f, offset, array, file);
        }
    } while (TIFFReadDirectory(tiff.get()) == 1);
    array.shape = pages == 1 ? std::vector<std::size_t>{first.height, first.width}
                             : std::vector<std::size_t>{pages, first.height, first.width};
    return array;
}

}  // namespace palpa::stiffnessmaps
