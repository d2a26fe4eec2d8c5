// Every kind of light that a LightSource directive may name.
KIND(point)
KIND(spot)
KIND(goniometric)
KIND(projection)
KIND(distant)
KIND(infinite)
