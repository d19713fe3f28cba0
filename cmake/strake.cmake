# Compiler settings and the two functions by which every part of the tree is declared.

add_library(strake_flags INTERFACE)
target_include_directories(strake_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(strake_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -Werror
                       # The same roundings on processors that multiply and add at once.
                       -ffp-contract=off
                       # GCC 12 sees overlaps in string concatenation that are not there (PR 105651).
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)

set(STRAKE_SANITIZE "" CACHE STRING "Sanitizers to build with, as for -fsanitize=")
if(STRAKE_SANITIZE)
  add_compile_options(-fsanitize=${STRAKE_SANITIZE} -fno-sanitize-recover=all
                      -fno-omit-frame-pointer)
  # With sanitizers GCC takes values in library headers for uninitialised that are not.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_link_options(-fsanitize=${STRAKE_SANITIZE})
endif()
if(STRAKE_SANITIZE MATCHES "thread")
  include_directories(BEFORE ${PROJECT_SOURCE_DIR}/tests/tsan) # loops that the sanitizer understands
endif()

# What makes an overrun end the program instead of being of use to someone.
include(CheckPIESupported)
check_pie_supported()
# Code for any address, of which libraries can be made, too; calls within a file are still inlined.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
target_compile_options(strake_flags INTERFACE -fno-semantic-interposition)
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT STRAKE_SANITIZE)
  add_compile_options(-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3 -fstack-protector-strong
                      -fstack-clash-protection)
  add_link_options(-Wl,-z,relro,-z,now,-z,noexecstack)
else()
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()

include(GNUInstallDirs)
set(STRAKE_INSTALL_HEADERS ${CMAKE_INSTALL_INCLUDEDIR}/strake)

# strake_library(NAME SOURCES... [DEPENDS targets...]): a static library strake_NAME.
function(strake_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(strake_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(strake_${name} PUBLIC ${ARG_DEPENDS}
                        PRIVATE $<BUILD_INTERFACE:strake_flags>)
  target_include_directories(strake_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<INSTALL_INTERFACE:${STRAKE_INSTALL_HEADERS}>)
endfunction()

# strake_optimise_less(TARGET): for code that is not what takes time: builds it faster.
function(strake_optimise_less target)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    target_compile_options(${target} PRIVATE -O1)
  endif()
endfunction()

# strake_program(NAME SOURCES... [DEPENDS targets...]): an executable in build/bin that is installed.
function(strake_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} strake_flags)
  if(NOT STRAKE_SANITIZE)
    target_link_libraries(${name} PRIVATE strake_huge_pages)
  endif()
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  set_property(GLOBAL APPEND PROPERTY STRAKE_PROGRAMS ${name})
endfunction()

# strake_stage(FOLDER [DEPENDS targets...]): the description strake_X_stage and the program strake-X of
# stages/FOLDER, around the library of the stage if there is one. X is the folder with dashes: the
# folder A/B is a program of stage A of its own, strake-A-B.
function(strake_stage folder)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  string(REPLACE "/" "-" name ${folder})
  string(REGEX REPLACE "/.*" "" stage ${folder})
  set(sources ${CMAKE_CURRENT_SOURCE_DIR}/${folder})
  strake_library(${name}_stage SOURCES ${sources}/stage.cpp DEPENDS strake_stage_values
                 ${ARG_DEPENDS})
  if(TARGET strake_${stage})
    target_link_libraries(strake_${name}_stage PUBLIC strake_${stage})
  endif()
  strake_program(strake-${name} SOURCES ${sources}/main.cpp DEPENDS strake_stage strake_${name}_stage)
endfunction()

# strake_test(NAME SOURCES... [DEPENDS targets...]): a GoogleTest executable, one ctest entry a case.
function(strake_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} strake_flags GTest::gtest_main)
  strake_optimise_less(${name})
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60)
endfunction()
