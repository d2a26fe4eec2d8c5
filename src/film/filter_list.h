// The kinds of filter; the first is what a scene gets that names none.
KIND(gaussian)
KIND(box)
KIND(triangle)
KIND(mitchell)
KIND(sinc)
