// What fills space, one line each.
KIND(homogeneous)
KIND(uniformgrid)
KIND(rgbgrid)
KIND(cloud)
KIND(nanovdb)
