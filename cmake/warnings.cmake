# Flags of our own targets only: every target of Palpa is made by palpa_library or palpa_executable.

add_library(palpa_flags INTERFACE)
target_include_directories(palpa_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(palpa_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Wold-style-cast
    -Wcast-align -Wunused -Woverloaded-virtual -Wdouble-promotion -Wformat=2 -Werror)
# One machine and build give one result: no contraction into fused operations behind our back.
target_compile_options(palpa_flags INTERFACE -ffp-contract=off)
# GCC 12.2 (Debian 12) makes wrong code at -O2: its loop vectoriser swaps neighbouring stores of a strided pattern
# (p[6] and p[7] of eight, in hex_box). Eigen's explicit vector code is not touched by this.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(palpa_flags INTERFACE -fno-tree-loop-vectorize)
endif()
# Templates fill the compiler's memory; collected from 1 GB on, not from 128 MB, they compile in 0.9 of the time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(palpa_flags INTERFACE --param=ggc-min-heapsize=1048576)
endif()
# Messages of assert name files as they lie in the project, not where this machine keeps it.
target_compile_options(palpa_flags INTERFACE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
# Sizes have 32 bits on the web: what is read as 64 is compared with what is there before it is used.
if(EMSCRIPTEN)
    target_compile_options(palpa_flags INTERFACE -Wno-shorten-64-to-32)
endif()
if(PALPA_SANITIZE)
    # What AddressSanitizer would find anyway takes UndefinedBehaviorSanitizer a seventh of the compile time, and two checks
    # that only the fuzz targets make, since wild pointers come from what is read, take 0.4 of it.
    set(unchecked null,object-size,vptr)
    if(NOT PALPA_FUZZ)
        string(APPEND unchecked ,alignment,pointer-overflow)
    endif()
    target_compile_options(palpa_flags INTERFACE -fsanitize=${PALPA_SANITIZE} -fno-sanitize=${unchecked}
                                                 -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(palpa_flags INTERFACE -fsanitize=${PALPA_SANITIZE})
    # Arrays on the stack: the indices of small matrices are asserted by Eigen, those of the standard library by itself. To watch
    # the stack as well takes a third of the time of compiler and tests; the fuzz targets, which are clang's, do watch it.
    target_compile_definitions(palpa_flags INTERFACE _GLIBCXX_ASSERTIONS)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_compile_options(palpa_flags INTERFACE --param=asan-stack=0)
    endif()
endif()

# With sanitizers, files that compute little compile at -O0: in 0.4 of the time. Not those that use Eigen: of a function that
# several files instantiate, the linker may keep the slow one for all.
if(PALPA_SANITIZE AND NOT PALPA_FUZZ)
    set(PALPA_LITTLE -O0)
endif()
# What is loaded over a network is small instead: PALPA_LITTLE, and PALPA_SMALL, of files that compute a little more.
if(EMSCRIPTEN)
    set(PALPA_LITTLE -Oz)
    set(PALPA_SMALL -Oz)
endif()

# DESK: sources that browsers do without.
function(palpa_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;DESK;USES" ${ARGN})
    if(NOT EMSCRIPTEN)
        list(APPEND ARG_SOURCES ${ARG_DESK})
    endif()
    add_library(palpa_${name} STATIC ${ARG_SOURCES})
    target_link_libraries(palpa_${name} PUBLIC palpa_flags ${ARG_USES})
endfunction()

function(palpa_executable name)
    cmake_parse_arguments(ARG "" "" "SOURCES;DESK;USES" ${ARGN})
    if(NOT EMSCRIPTEN)
        list(APPEND ARG_SOURCES ${ARG_DESK})
    endif()
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE palpa_flags ${ARG_USES})
endfunction()
