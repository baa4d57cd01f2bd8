# Installation and the Debian packages that CPack makes of it: boltwright, boltwright-content, boltwright-author and
# boltwright-dev.
# tools/make-packages.sh builds them, with debug symbols in packages of their own.
set(BOLT_PACKAGING ${CMAKE_SOURCE_DIR}/tools/package)

# Manual pages and completions are made from the programs' own options.
set(texts "")
foreach(program boltwright bolt-author)
    set(page ${CMAKE_BINARY_DIR}/package/${program}.1.gz)
    set(completion ${CMAKE_BINARY_DIR}/package/completions/${program})
    add_custom_command(OUTPUT ${page} ${completion}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/package/completions
        COMMAND bash -o pipefail -c "$<TARGET_FILE:${program}> --man-page | gzip -9n >${page}"
        COMMAND bash -c "$<TARGET_FILE:${program}> --bash-completion >${completion}"
        DEPENDS ${program} VERBATIM)
    list(APPEND texts ${page} ${completion})
endforeach()
file(READ ${BOLT_PACKAGING}/changelog log)
string(REGEX MATCH "^boltwright \\(([0-9.]+)\\)" ignored "${log}")
if(NOT CMAKE_MATCH_1 STREQUAL PROJECT_VERSION)
    message(FATAL_ERROR "tools/package/changelog begins with version ${CMAKE_MATCH_1}; expected ${PROJECT_VERSION}")
endif()
set(changelog ${CMAKE_BINARY_DIR}/package/changelog.gz)
add_custom_command(OUTPUT ${changelog} COMMAND sh -c "gzip -9nc ${BOLT_PACKAGING}/changelog >${changelog}"
    DEPENDS ${BOLT_PACKAGING}/changelog VERBATIM)
add_custom_target(package_texts ALL DEPENDS ${texts} ${changelog})

set(content share/boltwright/content)
install(TARGETS boltwright RUNTIME DESTINATION bin COMPONENT boltwright)
install(TARGETS bolt-arm-host RUNTIME DESTINATION lib/boltwright COMPONENT boltwright)
if(TARGET boltwright_mpi)
    install(TARGETS boltwright_mpi LIBRARY DESTINATION lib/boltwright COMPONENT boltwright)
endif()
install(DIRECTORY content/words DESTINATION ${content} COMPONENT boltwright FILES_MATCHING PATTERN "*.json")
# The person at a machine may use the devices that are plugged into it.
install(FILES tools/udev/60-boltwright.rules DESTINATION lib/udev/rules.d COMPONENT boltwright)
install(FILES ${BOLT_PACKAGING}/boltwright.desktop ${BOLT_PACKAGING}/boltwright-session.desktop DESTINATION share/applications COMPONENT boltwright)
install(FILES ${BOLT_PACKAGING}/boltwright.svg DESTINATION share/icons/hicolor/scalable/apps COMPONENT boltwright)
install(FILES ${BOLT_PACKAGING}/boltwright.xml DESTINATION share/mime/packages COMPONENT boltwright)
install(FILES ${BOLT_PACKAGING}/io.github.boltwright.metainfo.xml DESTINATION share/metainfo COMPONENT boltwright)
install(DIRECTORY content/assemblies content/environments content/hands content/questionnaires content/schema content/studies content/tools
    DESTINATION ${content} COMPONENT content FILES_MATCHING REGEX "\\.(json|glb|step|hdr)$")
install(FILES content/materials.json DESTINATION ${content} COMPONENT content)
install(TARGETS bolt-author RUNTIME DESTINATION bin COMPONENT author)
install(FILES content/AUTHORING.md DESTINATION share/doc/boltwright-author COMPONENT author)
install(FILES haptics/device/plugin/boltwright_arm.h DESTINATION include COMPONENT dev)
install(FILES tests/device/sample_arm/sample_arm.c DESTINATION share/doc/boltwright-dev/examples COMPONENT dev)
foreach(part boltwright:boltwright:boltwright author:boltwright-author:bolt-author content:boltwright-content: dev:boltwright-dev:)
    string(REPLACE ":" ";" part ${part})
    list(GET part 0 component)
    list(GET part 1 package)
    list(GET part 2 program)
    install(FILES ${BOLT_PACKAGING}/copyright ${changelog} DESTINATION share/doc/${package} COMPONENT ${component})
    if(program)
        install(FILES ${CMAKE_BINARY_DIR}/package/${program}.1.gz DESTINATION share/man/man1 COMPONENT ${component})
        install(FILES ${CMAKE_BINARY_DIR}/package/completions/${program}
            DESTINATION share/bash-completion/completions COMPONENT ${component})
    endif()
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_VENDOR Boltwright)
set(CPACK_PACKAGE_CONTACT "Boltwright maintainers <maintainers@boltwright.invalid>")
set(CPACK_COMPONENTS_ALL boltwright content author dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Everyone may read the installed folders, whatever the umask.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
if(CMAKE_BUILD_TYPE STREQUAL "RelWithDebInfo")
    set(CPACK_DEBIAN_DEBUGINFO_PACKAGE ON)
else()
    set(CPACK_STRIP_FILES ON)
endif()

set(CPACK_DEBIAN_BOLTWRIGHT_PACKAGE_NAME boltwright)
set(CPACK_DEBIAN_BOLTWRIGHT_PACKAGE_SECTION education)
# Vulkan and fonts are looked for at run time.
set(CPACK_DEBIAN_BOLTWRIGHT_PACKAGE_DEPENDS
    "boltwright-content (= ${PROJECT_VERSION}), libvulkan1, mesa-vulkan-drivers | vulkan-icd, fonts-dejavu-core, fonts-wqy-microhei")
set(CPACK_DEBIAN_BOLTWRIGHT_PACKAGE_RECOMMENDS "ffmpeg, zenity | kdialog | x11-utils")
set(CPACK_DEBIAN_BOLTWRIGHT_PACKAGE_SUGGESTS "boltwright-author, boltwright-dev")
# The first line is the synopsis; CPack indents the others.
set(CPACK_DEBIAN_BOLTWRIGHT_DESCRIPTION "trainer for tightening bolted joints by feel
A trainee takes a wrench to the joints of a machine and turns each nut through
run-down, seating, load and yield, with mouse and keyboard or with a device
that renders force. Lessons are recorded, replayed and explained in a report.")
set(CPACK_DEBIAN_CONTENT_PACKAGE_NAME boltwright-content)
set(CPACK_DEBIAN_CONTENT_PACKAGE_SECTION education)
set(CPACK_DEBIAN_CONTENT_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_CONTENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_CONTENT_DEBUGINFO_PACKAGE OFF)
set(CPACK_DEBIAN_CONTENT_DESCRIPTION "assemblies and tools for Boltwright
The gear reducer ZQ350, a flange DN 200, a bearing cover, wrenches, hands and
a workshop, as glTF models with their STEP sources; questionnaires for studies.")
set(CPACK_DEBIAN_AUTHOR_PACKAGE_NAME boltwright-author)
set(CPACK_DEBIAN_AUTHOR_PACKAGE_SECTION education)
set(CPACK_DEBIAN_AUTHOR_PACKAGE_DEPENDS "boltwright (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_AUTHOR_DESCRIPTION "makes assemblies for Boltwright
Imports STEP files, checks assemblies, shows their models, and computes the
torque, clamp force and curve of a bolted joint.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME boltwright-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEV_DEBUGINFO_PACKAGE OFF)
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS boltwright)
set(CPACK_DEBIAN_DEV_DESCRIPTION "header for force-feedback arms in Boltwright
A C header that describes plug-ins, with an example: a plug-in adds an arm to
Boltwright without its sources.")
include(CPack)
