#pragma once
// Files of arrays, written by the libraries whose formats they are.

#include <cstdio>
#include <filesystem>
#include <hdf5.h>
#include <matio.h>
#include <png.h>
#include <string>
#include <tiffio.h>
#include <vector>

namespace palpa::test {

// `values` in C order of `shape`; MATLAB's own order is made of them.
inline void write_mat(const std::filesystem::path& path, const std::string& name, const std::vector<std::size_t>& shape,
                      const std::vector<double>& values, bool packed = false, const char* version_7_3 = nullptr) {
    std::vector<double> turned(values.size());
    const std::size_t n_2 = shape.size() == 3 ? shape[2] : 1;
    for (std::size_t i = 0; i < shape[0]; ++i) {
        for (std::size_t j = 0; j < shape[1]; ++j) {
            for (std::size_t k = 0; k < n_2; ++k)
                turned[i + shape[0] * (j + shape[1] * k)] = values[(i * shape[1] + j) * n_2 + k];
        }
    }
    std::vector<std::size_t> dims = shape;
    const bool there = std::filesystem::exists(path);
    mat_t* mat = there ? Mat_Open(path.c_str(), MAT_ACC_RDWR)
                       : Mat_CreateVer(path.c_str(), nullptr, version_7_3 != nullptr ? MAT_FT_MAT73 : MAT_FT_MAT5);
    matvar_t* variable = Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, static_cast<int>(dims.size()),
                                       dims.data(), turned.data(), 0);
    Mat_VarWrite(mat, variable, packed ? MAT_COMPRESSION_ZLIB : MAT_COMPRESSION_NONE);
    Mat_VarFree(variable);
    Mat_Close(mat);
}

// Creates the file, or adds to it. `chunk` > 0: packed in chunks of so many numbers along each axis; without
// values nothing is stored.
inline void write_hdf5(const std::filesystem::path& path, const std::string& name,
                       const std::vector<std::size_t>& shape, const std::vector<float>& values, std::size_t chunk = 0) {
    const bool there = std::filesystem::exists(path);
    const hid_t file = there ? H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT)
                             : H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
    const std::vector<hsize_t> dims(shape.begin(), shape.end());
    const hid_t space = H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (chunk > 0) {
        const std::vector<hsize_t> chunks(shape.size(), chunk);
        H5Pset_chunk(how, static_cast<int>(chunks.size()), chunks.data());
        H5Pset_deflate(how, 6);
    }
    const hid_t data = H5Dcreate2(file, name.c_str(), H5T_IEEE_F32LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
    if (!values.empty()) H5Dwrite(data, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(data);
    H5Pclose(how);
    H5Sclose(space);
    H5Fclose(file);
}

// 16-bit grey; pages one after the other. `tile` > 0: in tiles of this width and height.
inline void write_tiff(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                       const std::vector<std::uint16_t>& pixels, std::uint32_t tile = 0,
                       std::uint16_t compression = COMPRESSION_LZW) {
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    const std::size_t n = std::size_t{width} * height;
    for (std::size_t page = 0; page * n < pixels.size(); ++page) {
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
        TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
        const std::uint16_t* first = &pixels[page * n];
        if (tile > 0) {
            TIFFSetField(tiff, TIFFTAG_TILEWIDTH, tile);
            TIFFSetField(tiff, TIFFTAG_TILELENGTH, tile);
            for (std::uint32_t y = 0; y < height; y += tile) {
                for (std::uint32_t x = 0; x < width; x += tile) {
                    std::vector<std::uint16_t> part(std::size_t{tile} * tile, 0);
                    for (std::uint32_t b = 0; b < tile && y + b < height; ++b) {
                        for (std::uint32_t a = 0; a < tile && x + a < width; ++a)
                            part[b * tile + a] = first[(y + b) * width + x + a];
                    }
                    TIFFWriteTile(tiff, part.data(), x, y, 0, 0);
                }
            }
        } else {
            TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 4);
            for (std::uint32_t y = 0; y < height; ++y) {
                std::vector<std::uint16_t> row(first + y * width, first + (y + 1) * width);
                TIFFWriteScanline(tiff, row.data(), y, 0);
            }
        }
        TIFFWriteDirectory(tiff);
    }
    TIFFClose(tiff);
}

// Grey of 16 bits (or 8), with a gamma in the file that must not change the numbers.
inline void write_png(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                      const std::vector<std::uint16_t>& pixels, int bits = 16, int colour = PNG_COLOR_TYPE_GRAY) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, width, height, bits, colour, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_gAMA_fixed(png, info, 45455);
    png_write_info(png, info);
    const std::size_t channels = colour == PNG_COLOR_TYPE_GRAY ? 1 : 3;
    for (std::uint32_t y = 0; y < height; ++y) {
        std::vector<unsigned char> row;
        for (std::uint32_t x = 0; x < width; ++x) {
            for (std::size_t c = 0; c < channels; ++c) {
                const std::uint16_t value = pixels[y * width + x];
                if (bits == 16) row.push_back(static_cast<unsigned char>(value >> 8));
                row.push_back(static_cast<unsigned char>(value & 0xff));
            }
        }
        png_write_row(png, row.data());
    }
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

}  // namespace palpa::test
