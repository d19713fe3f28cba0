# What `cmake --install` puts where: the programs, and the algorithms as a library for other projects
# (find_package(strake), targets strake::NAME), which needs neither HDF5 nor a command line.

# The libraries that the chain in memory consists of; each is exported as strake::NAME.
set(STRAKE_EXPORTED
    core topology poly_topology box_tree face_crossings surface_distance geometry patch_fill plane cell_error samples
    atomic_file meshfile stage_values count_search chain)
foreach(stage import tensor smooth coarsen prolong trace mesh lift decimate fit size refine evaluate)
  list(APPEND STRAKE_EXPORTED ${stage} ${stage}_stage)
endforeach()
list(APPEND STRAKE_EXPORTED refine-uncross_stage refine-worst_stage)

# strake::strake: all of it, behind the header strake/strake.h.
add_library(strake_all INTERFACE)
target_link_libraries(strake_all INTERFACE strake_chain strake_samples)
set_target_properties(strake_all PROPERTIES EXPORT_NAME strake)
set(targets strake_all)
foreach(name ${STRAKE_EXPORTED})
  set_target_properties(strake_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(strake_${name} PUBLIC cxx_std_20)
  list(APPEND targets strake_${name})
endforeach()
install(TARGETS ${targets} EXPORT strake-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)

# Headers keep their paths from the root, in a folder of their own.
foreach(folder common/core common/geometry)
  install(DIRECTORY ${folder}/ DESTINATION ${STRAKE_INSTALL_HEADERS}/${folder} COMPONENT development
          FILES_MATCHING PATTERN "*.h")
endforeach()
foreach(stage import tensor smooth coarsen prolong trace mesh lift decimate fit size refine evaluate)
  install(FILES stages/${stage}/${stage}.h DESTINATION ${STRAKE_INSTALL_HEADERS}/stages/${stage}
          COMPONENT development)
endforeach()
install(FILES stages/refine/worst.h DESTINATION ${STRAKE_INSTALL_HEADERS}/stages/refine
        COMPONENT development)
install(FILES common/artifact/meshfile/mesh_reader.h common/artifact/meshfile/mesh_writer.h
        DESTINATION ${STRAKE_INSTALL_HEADERS}/common/artifact/meshfile COMPONENT development)
install(FILES strake/strake.h DESTINATION ${STRAKE_INSTALL_HEADERS}/strake COMPONENT development)
install(FILES strake/chain/remesh.h DESTINATION ${STRAKE_INSTALL_HEADERS}/strake/chain
        COMPONENT development)

include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/strake)
configure_package_config_file(cmake/strakeConfig.cmake.in ${PROJECT_BINARY_DIR}/strakeConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/strakeConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/strakeConfig.cmake
              ${PROJECT_BINARY_DIR}/strakeConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT development)
install(EXPORT strake-targets NAMESPACE strake:: DESTINATION ${package_folder}
        COMPONENT development)

get_property(programs GLOBAL PROPERTY STRAKE_PROGRAMS)
install(TARGETS ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)

# Manual pages and completions: what each program prints of itself.
set(generated ${PROJECT_BINARY_DIR}/generated)
set(manuals)
foreach(program ${programs})
  set(pages man1/${program}.1 bash/${program} zsh/_${program} fish/${program}.fish)
  list(TRANSFORM pages PREPEND ${generated}/)
  list(GET pages 0 page)
  list(GET pages 1 bash)
  list(GET pages 2 zsh)
  list(GET pages 3 fish)
  add_custom_command(OUTPUT ${pages}
                     COMMAND ${program} --generate man > ${page}
                     COMMAND ${program} --generate bash > ${bash}
                     COMMAND ${program} --generate zsh > ${zsh}
                     COMMAND ${program} --generate fish > ${fish}
                     DEPENDS ${program} VERBATIM)
  list(APPEND manuals ${pages})
endforeach()
file(MAKE_DIRECTORY ${generated}/man1 ${generated}/bash ${generated}/zsh ${generated}/fish)
add_custom_target(strake_manuals ALL DEPENDS ${manuals})
install(DIRECTORY ${generated}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT programs)
install(DIRECTORY ${generated}/bash/ COMPONENT programs
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(DIRECTORY ${generated}/zsh/ COMPONENT programs
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(DIRECTORY ${generated}/fish/ COMPONENT programs
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
