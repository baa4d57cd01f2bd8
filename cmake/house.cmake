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
    string(REPLACE "fuzzer-no-link," "" BOLT_SANITIZE_LINK "${BOLT_SANITIZE}")
    target_link_options(house_options INTERFACE -fsanitize=${BOLT_SANITIZE_LINK})
endif()

# A machine that has no compiler cache builds all of it anew: there the headers that all have in common are parsed
# once. Not elsewhere: caches see what is in a parsed header only as long as nothing is overlooked, and a file that
# includes too little is found out.
if(NOT BOLT_CCACHE)
    add_library(house_headers OBJECT ${CMAKE_SOURCE_DIR}/cmake/house_headers.cpp)
    target_link_libraries(house_headers PRIVATE house_options)
    target_precompile_headers(house_headers PRIVATE ${CMAKE_SOURCE_DIR}/cmake/house_headers.hpp)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # Of headers parsed before, gcc 12 forgets that they are the system's, whose warnings it keeps to itself.
        target_compile_options(house_options INTERFACE -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
    endif()
endif()
function(house_parsed_headers name)
    if(TARGET house_headers)
        target_precompile_headers(${name} REUSE_FROM house_headers)
    endif()
endfunction()

# house_library(NAME SOURCES a.cpp ... [LINK public...] [PRIVATE private...])
function(house_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE" ${ARGN})
    if(ARG_SOURCES)
        add_library(${name} STATIC ${ARG_SOURCES})
        target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE house_options ${ARG_PRIVATE})
        target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
        house_parsed_headers(${name})
    else()
        add_library(${name} INTERFACE)
        target_link_libraries(${name} INTERFACE ${ARG_LINK})
        target_include_directories(${name} INTERFACE ${CMAKE_SOURCE_DIR})
    endif()
endfunction()

# house_program(NAME SOURCES a.cpp ... LINK targets... [TOGETHER]): TOGETHER compiles all sources as one, for programs of
# many commands: every file that reads a command line brings all of CLI11's code along, and takes ten seconds for it.
function(house_program name)
    cmake_parse_arguments(ARG "TOGETHER" "" "SOURCES;LINK" ${ARGN})
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE house_options ${ARG_LINK})
    house_parsed_headers(${name})
    if(ARG_TOGETHER)
        set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    endif()
endfunction()
