#include "render/png.h"

#include <png.h>
#include <stdexcept>

namespace palpa::render {

std::string png_bytes(int width_px, int height_px, const std::vector<unsigned char>& rgb) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width_px);
    image.height = static_cast<png_uint_32>(height_px);
    image.format = PNG_FORMAT_RGB;
    const auto fail = [&] { throw std::runtime_error(std::string("the picture cannot be made: ") + image.message); };
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
    png_alloc_size_t size = bytes.size();
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr)) fail();
    bytes.resize(size);
    return bytes;
}

}  // namespace palpa::render
