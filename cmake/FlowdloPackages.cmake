# Debian packages by CPack: libflowdlo0.1, libflowdlo-dev, flowdlo, flowdlo-lab, python3-flowdlo, flowdlo-ros.
# scripts/package configures a build for them: prefix /usr, no RUNPATH, Debian's place for Python packages.
if(NOT PROJECT_IS_TOP_LEVEL OR NOT BUILD_SHARED_LIBS OR NOT UNIX OR APPLE)
  return()
endif()
set(FLOWDLO_PACKAGE_MAINTAINER "The FlowDLO authors <authors@flowdlo.invalid>" CACHE STRING
    "Name and address that stand in packages")

set(abi "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
set(version "${PROJECT_VERSION}-1")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME flowdlo)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_VENDOR "FlowDLO")
set(CPACK_PACKAGE_CONTACT "${FLOWDLO_PACKAGE_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL library development command)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${FLOWDLO_PACKAGE_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SOURCE flowdlo)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/lib")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

# CPack puts the project's one line above every package's own unless that is the default one.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${CMAKE_PROJECT_NAME} built using CMake")
set(about "FlowDLO estimates the complete ordered 3D centerline of a rope, cable or\n\
hose from one RGB-D frame and its mask: 64 nodes from one end to the other,\n\
also where the rope crosses itself or is hidden.")

# flowdlo_package(COMPONENT NAME SECTION SUMMARY DEPENDS): one package and its papers.
function(flowdlo_package component name section summary depends)
  string(TOUPPER "${component}" upper)
  foreach(field NAME SECTION DEPENDS)
    string(TOLOWER "${field}" variable)
    set(CPACK_DEBIAN_${upper}_PACKAGE_${field} "${${variable}}" PARENT_SCOPE)
  endforeach()
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${about}" PARENT_SCOPE)

  set(papers "${PROJECT_BINARY_DIR}/papers/${name}")
  set(changelog "${papers}/changelog.Debian")
  string(TIMESTAMP date "%a, %d %b %Y 00:00:00 +0000" UTC)
  file(WRITE "${changelog}" "flowdlo (${version}) unstable; urgency=medium\n\n"
       "  * Version ${PROJECT_VERSION}: the project's CHANGELOG.md says what is new.\n\n"
       " -- ${FLOWDLO_PACKAGE_MAINTAINER}  ${date}\n")
  file(READ "${PROJECT_SOURCE_DIR}/LICENSE" licence)
  file(WRITE "${papers}/copyright" "FlowDLO, everything in this package:\n\n${licence}")
  find_program(FLOWDLO_GZIP gzip)
  if(FLOWDLO_GZIP)
    execute_process(COMMAND "${FLOWDLO_GZIP}" -9nf "${changelog}" COMMAND_ERROR_IS_FATAL ANY)
    string(APPEND changelog ".gz")
  endif()
  install(FILES "${changelog}" "${papers}/copyright" COMPONENT ${component} EXCLUDE_FROM_ALL
          DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${name}")
endfunction()

flowdlo_package(library libflowdlo${abi} libs "centerlines of ropes from RGB-D frames: the library" "")
flowdlo_package(development libflowdlo-dev libdevel
                "centerlines of ropes from RGB-D frames: headers"
                "libflowdlo${abi} (= ${version})")
flowdlo_package(command flowdlo science "centerlines of ropes from RGB-D frames: the command"
                "libflowdlo${abi} (= ${version})")
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "ffmpeg, flowdlo-lab")  # for --video; for synth and eval
if(TARGET flowdlo_lab_cli)  # apart: it draws with OpenCV, which brings many packages
  list(APPEND CPACK_COMPONENTS_ALL lab)
  flowdlo_package(lab flowdlo-lab science "centerlines of ropes from RGB-D frames: scenes and measurements"
                  "flowdlo (= ${version})")
endif()
set(compiles_python "${PROJECT_SOURCE_DIR}/cmake/debian/postinst;${PROJECT_SOURCE_DIR}/cmake/debian/prerm")
if(TARGET flowdlo_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${compiles_python}")
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  flowdlo_package(python python3-flowdlo python "centerlines of ropes from RGB-D frames: for Python"
                  "libflowdlo${abi} (= ${version}), python3-numpy, python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next})")
endif()
set(FLOWDLO_ROS_STAGE "" CACHE PATH "Where scripts/package has installed the packages of ROS 1; empty: no flowdlo-ros")
if(FLOWDLO_ROS_STAGE)
  list(APPEND CPACK_COMPONENTS_ALL ros)
  install(DIRECTORY "${FLOWDLO_ROS_STAGE}/usr/" DESTINATION "${CMAKE_INSTALL_PREFIX}" COMPONENT ros
          EXCLUDE_FROM_ALL USE_SOURCE_PERMISSIONS PATTERN "__pycache__" EXCLUDE)
  set(CPACK_DEBIAN_ROS_PACKAGE_CONTROL_EXTRA "${compiles_python}")
  set(CPACK_DEBIAN_ROS_PACKAGE_RECOMMENDS "python3-roslaunch, rosbash, libnodeletlib-tools")
  flowdlo_package(ros flowdlo-ros science "centerlines of ropes from RGB-D frames: for ROS 1"
                  "libflowdlo${abi} (= ${version}), python3, python3-genpy, python3-geometry-msgs, python3-std-msgs")
endif()
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/papers/triggers")
file(WRITE "${PROJECT_BINARY_DIR}/papers/triggers" "activate-noawait ldconfig\n")
file(CHMOD "${PROJECT_BINARY_DIR}/papers/triggers"
     PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
include(CPack)
