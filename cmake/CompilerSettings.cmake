# Language, warnings and sanitizers of every target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/lib")

# What plugins built elsewhere must share with this build, so that results do not depend on the
# machine they were compiled for: no contraction into fused operations, and one width of vectors in
# Eigen, whatever -march says. By the width Eigen orders its sums and aligns its memory (the ABI tag
# compares the latter); the compiler itself may use wider vectors, it changes no result by them. GCC
# 12 fuses alternating sums and differences in spite of -ffp-contract=off where the processor can,
# so it must not know that it can; AVX-512 has fused instructions of its own.
set(CORDON_SHARED_FLAGS -ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND CORDON_SHARED_FLAGS -U__AVX__ -U__AVX2__ -mno-fma -mno-fma4 -mno-avx512f)
endif()

# Nobody reads the flags of floating-point exceptions or the errno of functions of mathematics:
# without them, choices and square roots vectorise.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -fno-trapping-math
  -fno-math-errno ${CORDON_SHARED_FLAGS})
# GCC 12 and 13 see overlapping copies in assignments of literals to std::string that they have
# inlined (GCC's bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  add_compile_options(-Wno-restrict)
endif()
# Libraries call the templates that they were compiled with, not those of the same name that a
# program brings along: it may have been compiled with other options.
add_link_options($<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,SHARED_LIBRARY>:-Wl,-Bsymbolic-functions>
                 $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>:-Wl,-Bsymbolic-functions>)
if(CORDON_WARNINGS_AS_ERRORS)
  add_compile_options(-Werror)
endif()
if(CORDON_SANITIZE)
  add_compile_options(-fsanitize=${CORDON_SANITIZE} -fno-omit-frame-pointer)
  if(CORDON_SANITIZE MATCHES "undefined")
    # Checks of every pointer that AddressSanitizer catches at its use anyway; with Eigen they
    # double the time to compile.
    add_compile_options(-fno-sanitize=null,alignment,object-size,vptr)
  endif()
  # With the checks in the way GCC no longer sees that what is copied has been set.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-Wno-maybe-uninitialized)
  endif()
  add_link_options(-fsanitize=${CORDON_SANITIZE})
endif()

find_program(CORDON_CCACHE ccache)
if(CORDON_CCACHE)
  # ccache serves units with a precompiled header only where it may ignore when that was made.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros "${CORDON_CCACHE}")
endif()
