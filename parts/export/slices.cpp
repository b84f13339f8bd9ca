#include <algorithm>
#include <cmath>
#include <cstdio>
#include <png.h>
#include <stdexcept>

#include "files/input_error.h"
#include "files/text.h"
#include "mechanics/voxel_load.h"
#include "mechanics/voxels.h"
#include "parts/export/export.h"
#include "parts/export/new_folder.h"

namespace palpa::parts {
namespace {

using namespace mechanics;

constexpr int kMostPixelsAlong = 65'535;
constexpr std::int64_t kMostImages = 100'000;

// Pixels of all images: the box around the part, from its low corner.
struct SliceGrid {
    std::array<double, 3> per_voxel{};  // pixels per voxel
    std::array<int, 3> n{};
    FilledBox box;
    std::size_t row_bytes() const { return (static_cast<std::size_t>(n[0]) + 7) / 8; }

    // First pixel whose centre is at or above a voxel's boundary; the tolerance is that of regions.
    int pixel(int axis, int voxel) const {
        const auto a = static_cast<std::size_t>(axis);
        return std::clamp(static_cast<int>(std::ceil((voxel - box.low[a]) * per_voxel[a] - 0.5 - 1e-9)), 0, n[a]);
    }
};

SliceGrid slice_grid(const Part& part, const SlicePitch& pitch) {
    SliceGrid grid;
    grid.box = filled_box(part.voxels);
    const std::array<double, 3> pitch_m{pitch.x_m, pitch.y_m, pitch.z_m};
    for (std::size_t c = 0; c < 3; ++c) {
        grid.per_voxel[c] = part.voxels.frame.pitch_m / pitch_m[c];
        const double n = std::ceil((grid.box.high[c] - grid.box.low[c]) * grid.per_voxel[c] - 1e-6);
        if (!(n >= 1.0 && n <= kMostPixelsAlong)) {
            throw files::bad_input(part.file, "--pitch-um", files::short_number(n) + " pixels along an axis",
                                   "1 to " + std::to_string(kMostPixelsAlong));
        }
        grid.n[c] = static_cast<int>(n);
    }
    const auto images = std::int64_t{grid.n[2]} * static_cast<std::int64_t>(part.materials.size());
    if (images > kMostImages) {
        throw files::bad_input(part.file, "--pitch-um", std::to_string(images) + " images",
                               "at most " + std::to_string(kMostImages));
    }
    return grid;
}

// The voxel layer in which the middle of a layer of the printer lies; box.high[2] where that is above the part, as it may be of
// the last layer.
int voxel_layer(const SliceGrid& grid, int layer) {
    const int at = grid.box.low[2] + static_cast<int>(std::floor((layer + 0.5) / grid.per_voxel[2] + 1e-9));
    return std::min(at, grid.box.high[2]);
}

using Image = std::vector<std::uint8_t>;  // rows of whole bytes, the highest bit first

void draw_line(const SliceGrid& grid, int y, const std::vector<Run>& runs, std::vector<Image>& images,
               std::vector<std::int64_t>& pixels) {
    for (const Run& run : runs) {
        const int x0 = grid.pixel(0, run.x0), x1 = grid.pixel(0, run.x1);
        Image& image = images[static_cast<std::size_t>(run.material)];
        for (int row = grid.pixel(1, y); row < grid.pixel(1, y + 1); ++row) {
            std::uint8_t* bytes = image.data() + grid.row_bytes() * static_cast<std::size_t>(grid.n[1] - 1 - row);
            for (int x = x0; x < x1; ++x) bytes[x / 8] = static_cast<std::uint8_t>(bytes[x / 8] | 0x80U >> (x % 8));
            pixels[static_cast<std::size_t>(run.material)] += x1 - x0;
        }
    }
}

void append_bytes(png_structp png, png_bytep data, png_size_t n) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), n);
}
[[noreturn]] void png_failed(png_structp, png_const_charp why) {
    throw std::runtime_error(std::string("the slice cannot be made: ") + why);
}

// per_m: pixels per metre along x and y, which the file states.
std::string slice_png(const SliceGrid& grid, const Image& image, const std::array<double, 2>& per_m) {
    std::string out;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, &png_failed, nullptr);
    if (png == nullptr) throw std::runtime_error("the slice cannot be made");
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &out, &append_bytes, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(grid.n[0]), static_cast<png_uint_32>(grid.n[1]), 1,
                 PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_pHYs(png, info, static_cast<png_uint_32>(std::lround(per_m[0])),
                 static_cast<png_uint_32>(std::lround(per_m[1])), PNG_RESOLUTION_METER);
    png_write_info(png, info);
    for (int row = 0; row < grid.n[1]; ++row)
        png_write_row(png, image.data() + grid.row_bytes() * static_cast<std::size_t>(row));
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return out;
}

files::Json slices_json(const Part& part, const SliceGrid& grid, const SlicePitch& pitch) {
    // nanometres: the conversion from metres leaves 199.99999999999997 of 200
    const auto rounded = [](double length_um) { return std::round(1e3 * length_um) / 1e3; };
    files::Json json;
    json["part"] = part.name;
    json["pitch_um"] = {rounded(1e6 * pitch.x_m), rounded(1e6 * pitch.y_m), rounded(1e6 * pitch.z_m)};
    json["pixels"] = {grid.n[0], grid.n[1]};
    json["layers"] = grid.n[2];
    for (std::size_t c = 0; c < 3; ++c)
        json["corner_mm"].push_back(
            rounded(1e6 * (part.voxels.frame.origin_m[c] + part.voxels.frame.pitch_m * grid.box.low[c])) / 1e3);
    return json;
}

}  // namespace

std::vector<ExportedFile> export_slices(const Part& part, const SlicePitch& pitch,
                                        const std::filesystem::path& folder) {
    const SliceGrid grid = slice_grid(part, pitch);
    NewFolder made(folder);
    const std::vector<std::string> names = file_names(part);
    const std::size_t materials = part.materials.size();
    std::vector<ExportedFile> out;
    std::vector<Image> images(materials);
    std::vector<std::int64_t> pixels(materials);
    std::vector<bool> shown(materials);
    int drawn = -1;
    for (int layer = 0; layer < grid.n[2]; ++layer) {
        if (const int z = voxel_layer(grid, layer); z != drawn) {
            drawn = z;
            pixels.assign(materials, 0);
            for (Image& image : images) image.assign(grid.row_bytes() * static_cast<std::size_t>(grid.n[1]), 0);
            for (int y = grid.box.low[1]; z < grid.box.high[2] && y < grid.box.high[1]; ++y)
                draw_line(grid, y, part.voxels.lines[line_of(part.voxels, y, z)], images, pixels);
        }
        for (std::size_t m = 0; m < materials; ++m) {
            shown[m] = shown[m] || pixels[m] > 0;
            std::array<char, 24> number{};
            std::snprintf(number.data(), number.size(), "-%05d.png", layer);
            const std::string file = names[m] + number.data();
            files::write_text_whole(made.path() / file, slice_png(grid, images[m], {1.0 / pitch.x_m, 1.0 / pitch.y_m}));
            out.push_back({(folder / file).string(), part.materials[m].name, 0, pixels[m],
                           static_cast<double>(pixels[m]) * pitch.x_m * pitch.y_m * pitch.z_m});
        }
    }
    const mechanics::VoxelCounts voxels = mechanics::count(part.voxels, static_cast<int>(materials));
    for (std::size_t m = 0; m < materials; ++m) {
        if (shown[m] || voxels.of_material[m] == 0) continue;
        throw files::bad_input("--pitch-um", "", "pixels that all miss " + files::shown(part.materials[m].name),
                               "a pitch below the sizes of the part");
    }
    files::write_text_whole(made.path() / "slices.json", files::json_text(slices_json(part, grid, pitch)));
    made.keep();
    return out;
}

}  // namespace palpa::parts
