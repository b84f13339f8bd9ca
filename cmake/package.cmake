# What `cmake --install` puts where, and the .deb that CPack makes of it (scripts/package).

install(TARGETS palpa)
# what holds the ports of devices
install(TARGETS palpa_guard DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/palpa)
# what --simulate starts
install(TARGETS arm_simulator maestro_simulator DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/palpa)
if(PALPA_TANGIBLE)
    install(TARGETS tangible_plant DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/palpa)
endif()
install(DIRECTORY assets DESTINATION ${CMAKE_INSTALL_DATADIR}/palpa PATTERN desktop EXCLUDE)
# what `palpa serve` hands to tablets; scripts/package builds it
install(DIRECTORY build/web/site/ DESTINATION ${CMAKE_INSTALL_DATADIR}/palpa/web OPTIONAL)
install(FILES assets/desktop/palpa.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES assets/desktop/palpa.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
foreach(size 32 48 64 128 256)
    install(FILES assets/desktop/palpa-${size}.png RENAME palpa.png
            DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/${size}x${size}/apps)
endforeach()
install(FILES README.md CHANGELOG.md TYPE DOC)
install(DIRECTORY docs TYPE DOC)  # the README links into it

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME palpa)
set(CPACK_PACKAGE_CONTACT "The Palpa maintainers <maintainers@palpa.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "feel stiffness on a touch screen by pen or finger pressure")
set(CPACK_PACKAGE_DESCRIPTION "Palpa turns the pressure of a pen or a finger on a screen into newtons, asks a tissue how it
answers, and shows the answer by slowing or delaying the indenter's avatar: the eye reads that
as stiffness. For trainees who palpate virtual tumours, experimenters and study scripts.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# SDL opens the EGL library by name, Dear ImGui's loader the GL library, so dpkg-shlibdeps sees neither
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libgl1")
# figures; a readable font; drawing where there is no other driver
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox, fonts-dejavu-core, libgl1-mesa-dri")
include(CPack)
