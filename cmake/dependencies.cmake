# Everything from Debian 12; scripts/setup installs it.
if(EMSCRIPTEN)
    include(cmake/web.cmake)
    return()
endif()

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Boost 1.74 REQUIRED)  # headers of Boost.Math
find_package(glm REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(doctest 2.4 REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)  # CRC-32
pkg_check_modules(SDL2 REQUIRED IMPORTED_TARGET sdl2)
pkg_check_modules(X11 REQUIRED IMPORTED_TARGET x11 xi)
pkg_check_modules(GLES REQUIRED IMPORTED_TARGET glesv2)
pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
pkg_check_modules(FONTCONFIG REQUIRED IMPORTED_TARGET fontconfig)
find_package(OpenSSL 3 REQUIRED)
pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib)
pkg_check_modules(QRENCODE REQUIRED IMPORTED_TARGET libqrencode)
# parts for printers; its pkg-config file names libzip for linking too, whose headers lib3mf-dev does without
find_library(LIB3MF_LIBRARY 3MF REQUIRED)
find_path(LIB3MF_INCLUDE Model/COM/NMR_DLLInterfaces.h PATH_SUFFIXES lib3mf REQUIRED)
add_library(palpa_lib3mf INTERFACE)
target_include_directories(palpa_lib3mf SYSTEM INTERFACE ${LIB3MF_INCLUDE})
target_link_libraries(palpa_lib3mf INTERFACE ${LIB3MF_LIBRARY})
# recordings: MATLAB, HDF5 and TIFF files
pkg_check_modules(MATIO REQUIRED IMPORTED_TARGET matio)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5)
find_package(TIFF REQUIRED)
if(PALPA_BENCH)
    find_package(benchmark 1.7 REQUIRED)
endif()

# Sparse Cholesky, sequential MUMPS on OpenBLAS. Both have no CMake or pkg-config files of their own.
option(PALPA_MUMPS "Use MUMPS for sparse Cholesky; without it Eigen's, some 15 times slower" ON)
if(PALPA_MUMPS)
    find_library(MUMPS_LIBRARY dmumps_seq REQUIRED)
    find_path(MUMPS_INCLUDE dmumps_c.h REQUIRED)
    find_library(OPENBLAS_LIBRARY openblas REQUIRED)
    add_library(palpa_mumps INTERFACE)
    target_include_directories(palpa_mumps SYSTEM INTERFACE ${MUMPS_INCLUDE})
    # MUMPS first, then OpenBLAS: its symbols win over whatever libblas.so.3 the system has chosen
    target_link_libraries(palpa_mumps INTERFACE ${MUMPS_LIBRARY} ${OPENBLAS_LIBRARY})
endif()

# Images: two modules of OpenCV. Its CMake files come only with the package of all modules, five times as large.
find_library(OPENCV_CORE_LIBRARY opencv_core REQUIRED)
find_library(OPENCV_IMGPROC_LIBRARY opencv_imgproc REQUIRED)
find_path(OPENCV_INCLUDE opencv2/imgproc.hpp PATH_SUFFIXES opencv4 REQUIRED)
add_library(palpa_opencv INTERFACE)
target_include_directories(palpa_opencv SYSTEM INTERFACE ${OPENCV_INCLUDE})
target_link_libraries(palpa_opencv INTERFACE ${OPENCV_IMGPROC_LIBRARY} ${OPENCV_CORE_LIBRARY})
