# OpenCV, for the command, the lab and the tests: opencv_core and opencv_imgproc, OpenCV_LIBS and
# OpenCV_INCLUDE_DIRS, and flowdlo_opencv, which is all of these and the headers of support/ that join them
# with engine/image. Its own configuration comes with 300 packages on a bare Debian; the headers and
# the libraries come without. Tests and the lab also link opencv_imgcodecs.
set(libraries core imgproc)
set(more)
if(FLOWDLO_BUILD_LAB OR FLOWDLO_BUILD_TESTS)
  list(APPEND libraries imgcodecs)
  set(more OPTIONAL_COMPONENTS calib3d)
endif()
find_package(OpenCV 4.5 QUIET COMPONENTS ${libraries} ${more})
set(OpenCV_LIBS opencv_core opencv_imgproc)
if(NOT OpenCV_FOUND)
  find_path(FLOWDLO_OPENCV_INCLUDE_DIR opencv2/imgproc.hpp REQUIRED PATH_SUFFIXES opencv4
            DOC "Folder of opencv2/; Debian and Ubuntu: libopencv-core-dev, libopencv-imgproc-dev")
  mark_as_advanced(FLOWDLO_OPENCV_INCLUDE_DIR)
  set(OpenCV_INCLUDE_DIRS "${FLOWDLO_OPENCV_INCLUDE_DIR}")
  list(TRANSFORM libraries PREPEND opencv_)
  foreach(library IN LISTS libraries)
    find_library(FLOWDLO_${library} ${library} REQUIRED)
    mark_as_advanced(FLOWDLO_${library})
    add_library(${library} UNKNOWN IMPORTED)
    set_target_properties(${library} PROPERTIES IMPORTED_LOCATION "${FLOWDLO_${library}}"
                                                INTERFACE_INCLUDE_DIRECTORIES "${OpenCV_INCLUDE_DIRS}")
  endforeach()
endif()

add_library(flowdlo_opencv INTERFACE)
target_include_directories(flowdlo_opencv INTERFACE "${PROJECT_SOURCE_DIR}/support")
target_include_directories(flowdlo_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
target_link_libraries(flowdlo_opencv INTERFACE ${OpenCV_LIBS})
