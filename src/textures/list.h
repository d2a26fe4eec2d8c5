// The textures, one line each; every one serves numbers and colours.
KIND(constant)
KIND(imagemap)
KIND(checkerboard)
KIND(scale)
KIND(mix)
