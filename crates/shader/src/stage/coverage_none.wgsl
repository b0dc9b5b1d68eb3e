// Pixels are not parted.

/// Leaves the rays from the eye of a pixel in `waiting`, and gives how many there are.
fn parts_of_pixel(own: Onward, waiting: ptr<function, array<Onward, WAITING>>) -> u32 {
    (*waiting)[0] = own;
    return 1u;
}
