# Installation and find_package(grainlaw).
