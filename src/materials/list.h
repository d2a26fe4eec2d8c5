// The materials, one line each.
KIND(phong)
KIND(diffuse)
KIND(conductor)
KIND(dielectric)
KIND(thindielectric)
KIND(mix)
KIND(interface)
