# Finds Python and pybind11 for the Python package in python/. A wheel (SKBUILD) is built for the
# Python of pip; all other builds use Debian's Python, for which Debian has NumPy and pytest.
if(NOT SKBUILD AND NOT DEFINED Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
set(PYBIND11_FINDPYTHON ON)
find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module)
if(Python_FOUND)
  find_package(pybind11 2.10 QUIET CONFIG)
endif()
option(TRACKBED_PYTHON "Build the Python package (pybind11)" ${pybind11_FOUND})
if(TRACKBED_PYTHON AND NOT pybind11_FOUND)
  message(FATAL_ERROR "TRACKBED_PYTHON needs Python 3.9 or later and pybind11 2.10 or later, with "
                      "their headers: install Debian's python3-dev and pybind11-dev, or set "
                      "TRACKBED_PYTHON=OFF")
endif()
