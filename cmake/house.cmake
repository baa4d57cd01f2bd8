# How every target of the house is built: one place for warnings, sanitizers and reproducible floating point.

find_program(BOLT_CCACHE ccache)
if(BOLT_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${BOLT_CCACHE})
endif()

add_library(house_options INTERFACE)
target_compile_options(house_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast -Wnon-virtual-dtor
    -Woverloaded-virtual -Wcast-align -Wnull-dereference -Wdouble-promotion -Wformat=2 -Werror
    # Same inputs, same bits: no contraction to FMA, so debug, release and both compilers agree.
    -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc 12 sees null dereferences and overreads in inlined libstdc++ code that are not there.
    target_compile_options(house_options INTERFACE -Wno-null-dereference -Wno-restrict)
endif()
target_include_directories(house_options INTERFACE ${CMAKE_SOURCE_DIR})
if(BOLT_SANITIZE)
    target_compile_options(house_options INTERFACE -fsanitize=${BOLT_SANITIZE} -fno-sanitize-recover=all
        -fno-omit-frame-pointer)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # Instrumented code hides from gcc what is initialised where (libstdc++'s regex, std::function).
        target_compile_options(house_options INTERFACE -Wno-maybe-uninitialized)
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND BOLT_SANITIZE MATCHES "undefined")
        # A fifth of the time to compile, a quarter of that to run. AddressSanitizer sees the first two as well, and the fuzz preset has
        # all three, for what parses.
        target_compile_options(house_options INTERFACE -fno-sanitize=null,object-size,alignment)
    endif()
    if(CMAKE_BUILD_TYPE STREQUAL "Debug")
        # What tests have done a million times would take most of their time: HOT libraries are optimised here too.
        set(BOLT_HOT -O2)
        set(BOLT_HOT_HEADERS house_headers_hot)  # gcc 12 crashes on headers that were parsed at another level
    endif()
    string(REPLACE "fuzzer-no-link," "" BOLT_SANITIZE_LINK "${BOLT_SANITIZE}")
    target_link_options(house_options INTERFACE -fsanitize=${BOLT_SANITIZE_LINK})
endif()

# A machine that has no compiler cache builds all of it anew: there the headers that all have in common are parsed
# once. Not elsewhere: caches see what is in a parsed header only as long as nothing is overlooked, and a file that
# includes too little is found out.
if(NOT BOLT_CCACHE)
    foreach(headers house_headers ${BOLT_HOT_HEADERS})
        add_library(${headers} OBJECT ${CMAKE_SOURCE_DIR}/cmake/house_headers.cpp)
        target_link_libraries(${headers} PRIVATE house_options)
        target_precompile_headers(${headers} PRIVATE ${CMAKE_SOURCE_DIR}/cmake/house_headers.hpp)
    endforeach()
    if(BOLT_HOT)
        target_compile_options(${BOLT_HOT_HEADERS} PRIVATE ${BOLT_HOT})
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # Of headers parsed before, gcc 12 forgets that they are the system's, whose warnings it keeps to itself.
        target_compile_options(house_options INTERFACE -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
    endif()
endif()
function(house_optimisation name is_hot)
    set(headers house_headers)
    if(is_hot AND BOLT_HOT)
        target_compile_options(${name} PRIVATE ${BOLT_HOT})
        set(headers ${BOLT_HOT_HEADERS})
    endif()
    if(TARGET ${headers})
        target_precompile_headers(${name} REUSE_FROM ${headers})
    endif()
endfunction()

# house_library(NAME SOURCES a.cpp ... [LINK public...] [PRIVATE private...] [HOT])
function(house_library name)
    cmake_parse_arguments(ARG "HOT" "" "SOURCES;LINK;PRIVATE" ${ARGN})
    if(ARG_SOURCES)
        add_library(${name} STATIC ${ARG_SOURCES})
        target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE house_options ${ARG_PRIVATE})
        target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
        house_optimisation(${name} ${ARG_HOT})
    else()
        add_library(${name} INTERFACE)
        target_link_libraries(${name} INTERFACE ${ARG_LINK})
        target_include_directories(${name} INTERFACE ${CMAKE_SOURCE_DIR})
    endif()
endfunction()

# house_program(NAME SOURCES a.cpp ... LINK targets... [TOGETHER] [HOT]): TOGETHER compiles all sources as one, for programs of
# many commands: every file that reads a command line brings all of CLI11's code along, and takes ten seconds for it.
function(house_program name)
    cmake_parse_arguments(ARG "TOGETHER;HOT" "" "SOURCES;LINK" ${ARGN})
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE house_options ${ARG_LINK})
    house_optimisation(${name} ${ARG_HOT})
    if(ARG_TOGETHER)
        set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    endif()
endfunction()
