# Run by project() of a consumer: PCL has been found, with more of its parts, before the package looks for it.
find_package(PCL QUIET REQUIRED COMPONENTS search segmentation)
