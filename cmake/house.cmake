# Build settings of all targets: warnings, sanitizers and reproducible floating point. Names that begin with house_ are this project's
# own functions and rules.

# The sources of a target are compiled as one file, which takes a third less CPU time (boltwright: 435 s instead of 692 s). So a name
# in an unnamed namespace must be unique in its target. The debug preset compiles each file by itself, and rebuilds faster.
# Libraries marked SEPARATE are compiled file by file in every preset: collision and proxy as one file each make a lesson's frames
# slower (docs/performance.md).
option(BOLT_UNITY "Compile the sources of a target as one file" ON)
set(CMAKE_UNITY_BUILD ${BOLT_UNITY})
set(CMAKE_UNITY_BUILD_BATCH_SIZE 0)

find_program(BOLT_CCACHE ccache)
if(BOLT_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${BOLT_CCACHE})
endif()

add_library(house_options INTERFACE)
# -Wno-missing-field-initializers: structures of Vulkan and OpenXR are initialised with their type alone.
target_compile_options(house_options INTERFACE
    -Wall -Wextra -Wpedantic -Wno-missing-field-initializers -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast -Wnon-virtual-dtor
    -Woverloaded-virtual -Wcast-align -Wnull-dereference -Wdouble-promotion -Wformat=2 -Werror
    # The same inputs must give the same bits: without contraction to FMA, debug, release and both compilers agree.
    -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc 12 reports null dereferences and overreads in inlined libstdc++ code that do not exist.
    target_compile_options(house_options INTERFACE -Wno-null-dereference -Wno-restrict)
    # gcc collects its garbage from 128 MiB on, which takes a tenth of the time of a target's one large file.
    target_compile_options(house_options INTERFACE --param=ggc-min-heapsize=524288)
    if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
        # gcc clears and copies structures of 40 to 512 bytes with `rep stos` and `rep movs`, which take 20 ns to start. A servo tick
        # does so several times: each Status reserves the space of an Error.
        set(vector_loop "=vector_loop:512:noalign,rep_8byte:8192:noalign,libcall:-1:noalign")
        target_compile_options(house_options INTERFACE -mmemset-strategy${vector_loop} -mmemcpy-strategy${vector_loop})
    endif()
    if(CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
        # gcc 14 reports every reference that a function returns if one of its arguments is a temporary view, such as ecs::Access.
        target_compile_options(house_options INTERFACE -Wno-dangling-reference)
    endif()
    if(BOLT_UNITY)
        # The one file of a target includes its .cpp files, so gcc treats them as headers. It then warns of types in them that use names
        # of an unnamed namespace, although no other file includes them.
        target_compile_options(house_options INTERFACE -Wno-subobject-linkage -Wno-attributes)
    endif()
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    # clang 14 reports explicit conversions such as double{x} too.
    target_compile_options(house_options INTERFACE -Wno-double-promotion)
    if(BOLT_UNITY)
        # clang reports a local name that another file of the same target uses in its unnamed namespace.
        target_compile_options(house_options INTERFACE -Wno-shadow)
    endif()
endif()
target_include_directories(house_options INTERFACE ${CMAKE_SOURCE_DIR})
# The linker keeps one copy of an inline function that is not inlined, which may be that of a COLD target. The product of quaternion and vector then made a servo tick 0.3 µs longer (docs/performance.md). So all functions of glm are inlined.
target_compile_definitions(house_options INTERFACE GLM_FORCE_INLINE)
if(BOLT_SANITIZE)
    target_compile_options(house_options INTERFACE -fsanitize=${BOLT_SANITIZE} -fno-sanitize-recover=all
        -fno-omit-frame-pointer)
    if(BOLT_SANITIZE MATCHES "address")
        target_compile_definitions(house_options INTERFACE BOLT_SANITIZES_ADDRESS)
    endif()
    if(BOLT_SANITIZE MATCHES "thread")
        target_compile_definitions(house_options INTERFACE BOLT_SANITIZES_THREAD)
    endif()
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND BOLT_SANITIZE MATCHES "undefined")
        # The emulated libraries of the arms' vendors define the structures of their C functions under other names than our code.
        target_compile_options(house_options INTERFACE -fno-sanitize=function)
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # Instrumentation hides initialisations from gcc (libstdc++'s regex, std::function).
        target_compile_options(house_options INTERFACE -Wno-maybe-uninitialized)
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND BOLT_SANITIZE MATCHES "undefined")
        # These checks would take a fifth of the compile time and a quarter of the run time. AddressSanitizer detects the first
        # two as well, and the asan preset, which uses clang, enables all three.
        target_compile_options(house_options INTERFACE -fno-sanitize=null,object-size,alignment)
    endif()
    if(CMAKE_BUILD_TYPE STREQUAL "Debug")
        # Tests spend most of their time in HOT libraries.
        set(BOLT_FLAGS_HOT -O2)
    endif()
    target_link_options(house_options INTERFACE -fsanitize=${BOLT_SANITIZE})
    if(BOLT_FUZZ)
        # libFuzzer's counters, which code that only tests run does not need.
        target_compile_options(house_options INTERFACE $<$<NOT:$<BOOL:$<TARGET_PROPERTY:HOUSE_TEST>>>:-fsanitize=fuzzer-no-link>)
    endif()
    if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
        # clang compiles instrumented code in half of the time without optimisation. COLD libraries and most tests compute little.
        set(BOLT_FLAGS_COLD -O0)
        set(BOLT_FLAGS_TEST -O0)
    endif()
    # Links in a quarter of the time of GNU ld.
    find_program(BOLT_LLD ld.lld)
    if(BOLT_LLD)
        target_link_options(house_options INTERFACE -fuse-ld=lld)
    endif()
endif()

# COLD targets compute little: they read and write files, run commands, test, or run once a frame. -Og compiles up to twice as fast as
# -O3. At this level gcc 12 reports initialised variables as uninitialised.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
    set(BOLT_FLAGS_COLD -Og -Wno-maybe-uninitialized)
endif()

# Without a compiler cache the common headers are precompiled, once for each optimisation level: gcc 12 crashes on those of another
# level. With a cache they are not precompiled: a cache may overlook a change inside a precompiled header, and files with missing includes would
# go unnoticed.
if(NOT BOLT_CCACHE)
    foreach(level "" _HOT _COLD _TEST)
        if(NOT level OR BOLT_FLAGS${level})
            string(TOLOWER "house_headers${level}" headers)
            add_library(${headers} OBJECT ${CMAKE_SOURCE_DIR}/cmake/house_headers.cpp)
            target_link_libraries(${headers} PRIVATE house_options)
            target_compile_options(${headers} PRIVATE ${BOLT_FLAGS${level}})
            if(level STREQUAL "_TEST")
                set_target_properties(${headers} PROPERTIES HOUSE_TEST ON)
            endif()
            target_precompile_headers(${headers} PRIVATE ${CMAKE_SOURCE_DIR}/cmake/house_headers.hpp)
        endif()
    endforeach()
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # gcc 12 treats precompiled system headers as our own and reports their warnings.
        target_compile_options(house_options INTERFACE -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
    endif()
endif()

# house_optimisation(NAME LEVEL): LEVEL is HOT, COLD, TEST or empty. Tests are compiled like COLD targets if TEST has no flags.
function(house_optimisation name level)
    if(level STREQUAL "TEST" AND NOT BOLT_FLAGS_TEST)
        set(level COLD)
    endif()
    if(NOT level OR NOT BOLT_FLAGS_${level})
        set(level "")
    else()
        set(level _${level})
    endif()
    if(level STREQUAL "_TEST")
        set_target_properties(${name} PROPERTIES HOUSE_TEST ON)
    endif()
    target_compile_options(${name} PRIVATE ${BOLT_FLAGS${level}})
    string(TOLOWER "house_headers${level}" headers)
    if(TARGET ${headers})
        target_precompile_headers(${name} REUSE_FROM ${headers})
    endif()
endfunction()

# house_level(VARIABLE): the level among the arguments that cmake_parse_arguments found.
macro(house_level variable)
    set(${variable} "")
    foreach(candidate HOT COLD TEST)
        if(ARG_${candidate})
            set(${variable} ${candidate})
        endif()
    endforeach()
endmacro()

# house_without_sanitizers(FILE): compiles a file without sanitizers in the asan preset. Those that use Boost.Beast would take twice as
# long, and no fuzzer calls them. clang refuses precompiled headers that are instrumented otherwise.
function(house_without_sanitizers file)
    if(BOLT_FUZZ)
        set_source_files_properties(${file} PROPERTIES COMPILE_OPTIONS "-fno-sanitize=all" SKIP_UNITY_BUILD_INCLUSION ON
            SKIP_PRECOMPILE_HEADERS ON)
    endif()
endfunction()

# house_library(NAME SOURCES a.cpp ... [LINK public...] [PRIVATE private...] [HOT|COLD] [FUZZED] [SEPARATE])
# HOT: compiled with -O2 under sanitizers, because tests spend most of their time in it. COLD: little optimised, because it computes
# little (gcc: -Og, clang under sanitizers: -O0). FUZZED: not COLD where the fuzzers are built, because they spend their time in it. SEPARATE: no unity build.
function(house_library name)
    cmake_parse_arguments(ARG "HOT;COLD;FUZZED;SEPARATE" "" "SOURCES;LINK;PRIVATE" ${ARGN})
    if(ARG_SOURCES)
        house_level(level)
        if(ARG_FUZZED AND BOLT_FUZZ)
            set(level "")
        endif()
        add_library(${name} STATIC ${ARG_SOURCES})
        target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE house_options ${ARG_PRIVATE})
        target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR})
        house_optimisation(${name} "${level}")
        if(ARG_SEPARATE)
            set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
        endif()
    else()
        add_library(${name} INTERFACE)
        target_link_libraries(${name} INTERFACE ${ARG_LINK})
        target_include_directories(${name} INTERFACE ${CMAKE_SOURCE_DIR})
    endif()
endfunction()

# house_program(NAME SOURCES a.cpp ... LINK targets... [HOT|COLD|TEST])
function(house_program name)
    cmake_parse_arguments(ARG "HOT;COLD;TEST" "" "SOURCES;LINK" ${ARGN})
    house_level(level)
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE house_options ${ARG_LINK})
    house_optimisation(${name} "${level}")
endfunction()
