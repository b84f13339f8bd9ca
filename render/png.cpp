#include "render/png.h"

#include <png.h>

#include <stdexcept>
#include <string>

namespace palpa {

void write_png(const std::filesystem::path& path, int width_px, int height_px, const std::vector<unsigned char>& rgb) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width_px);
    image.height = static_cast<png_uint_32>(height_px);
    image.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_file(&image, path.c_str(), 0, rgb.data(), 0, nullptr)) {
        throw std::runtime_error(path.string() + ": cannot be written: " + image.message);
    }
}

}  // namespace palpa
