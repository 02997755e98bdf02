# Debian's packages; scripts/install-dependencies installs them.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Boost 1.74 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(CLI11 REQUIRED)
find_path(GLPK_INCLUDE_DIR glpk.h REQUIRED)
find_library(GLPK_LIBRARY glpk REQUIRED)
add_library(glpk INTERFACE)
target_include_directories(glpk SYSTEM INTERFACE "${GLPK_INCLUDE_DIR}")
target_link_libraries(glpk INTERFACE "${GLPK_LIBRARY}")
find_library(GMP_LIBRARY gmp REQUIRED)
find_library(MPFR_LIBRARY mpfr REQUIRED)
find_library(GMPXX_LIBRARY gmpxx REQUIRED)
add_library(gmp INTERFACE)
target_link_libraries(gmp INTERFACE "${GMPXX_LIBRARY}" "${GMP_LIBRARY}")
add_library(mpfr INTERFACE)
target_link_libraries(mpfr INTERFACE "${MPFR_LIBRARY}" gmp)
# cddlib over GMP rationals, a second opinion on exact answers. libcddgmp holds the double version
# too: linking libcdd beside it crashes.
find_path(CDD_INCLUDE_DIR cdd.h PATH_SUFFIXES cddlib REQUIRED)
find_library(CDDGMP_LIBRARY cddgmp REQUIRED)
add_library(cddgmp INTERFACE)
target_include_directories(cddgmp SYSTEM INTERFACE "${CDD_INCLUDE_DIR}")
target_compile_definitions(cddgmp INTERFACE GMPRATIONAL)
target_link_libraries(cddgmp INTERFACE "${CDDGMP_LIBRARY}" gmp)
# SDPA, a static library, over the reference LAPACK and BLAS, static too. A tuned BLAS picks its
# kernels by the processor, and each rounds in its own way: gains would differ from machine to
# machine, and OpenBLAS starts threads as soon as it is loaded. So the archives are taken by their
# packages' own places; the names one level above are what the machine's alternatives say. Nothing
# of them is exported. What SDPA does with the process (std::cout, exit, abort) goes to
# solvers/sdp_sdpa.cpp, which also answers in place of MUMPS.
find_path(SDPA_INCLUDE_DIR sdpa_call.h REQUIRED)
# SDPA's headers include those of MUMPS
find_path(MUMPS_SEQ_INCLUDE_DIR mpi.h PATH_SUFFIXES mumps_seq REQUIRED)
find_library(SDPA_LIBRARY libsdpa.a REQUIRED)
foreach(name LAPACK BLAS)
  string(TOLOWER ${name} package)
  find_library(REFERENCE_${name} lib${package}.a PATHS
    "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/${package}" NO_DEFAULT_PATH)
  if(NOT REFERENCE_${name})
    message(FATAL_ERROR
      "The static reference ${name} is missing: scripts/install-dependencies, or apt-get install lib${package}-dev; "
                        "elsewhere set REFERENCE_${name} to its lib${package}.a")
  endif()
endforeach()
find_package(Threads REQUIRED)
add_library(sdpa INTERFACE)
target_include_directories(sdpa SYSTEM INTERFACE "${SDPA_INCLUDE_DIR}" "${MUMPS_SEQ_INCLUDE_DIR}")
target_link_libraries(sdpa INTERFACE "${SDPA_LIBRARY}" "${REFERENCE_LAPACK}" "${REFERENCE_BLAS}"
  Threads::Threads)
target_link_options(sdpa INTERFACE
  "LINKER:--wrap=exit,--wrap=abort,--wrap=_ZSt4cout,--exclude-libs,libsdpa.a:liblapack.a:libblas.a")
# MAT-files of MATLAB.
find_path(MATIO_INCLUDE_DIR matio.h)
find_library(MATIO_LIBRARY matio)
if(NOT MATIO_INCLUDE_DIR OR NOT MATIO_LIBRARY)
  message(FATAL_ERROR
    "libmatio is missing, which reads and writes MAT-files: scripts/install-dependencies, or apt-get install libmatio-dev")
endif()
add_library(matio INTERFACE)
target_include_directories(matio SYSTEM INTERFACE "${MATIO_INCLUDE_DIR}")
target_link_libraries(matio INTERFACE "${MATIO_LIBRARY}")
find_package(ZLIB REQUIRED)  # their compression
# Chart.js, which becomes a part of every report.
find_file(CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js
  /usr/share/nodejs/chart.js/dist)
if(NOT CHART_JS)
  message(FATAL_ERROR
    "Chart.js is missing (chart.min.js, version 3): scripts/install-dependencies installs it, or set CHART_JS to the file.")
endif()
file(READ "${CHART_JS}" chart_js_head LIMIT 200)
if(NOT chart_js_head MATCHES "Chart\\.js v3\\.")
  message(FATAL_ERROR "${CHART_JS} is not version 3 of Chart.js.")
endif()
