// MuJoCo's contacts between boxes, without those that aren't there.
#pragma once

namespace pmg::sim {

/// Where one box rests flat on another, MuJoCo's collider of boxes (2.2.2, and at least up to 3.11) now and then
/// returns a contact about as deep as a box is wide, far from where they touch; its force throws the box into the air
/// at metres a second. A box of 1 kg on a table meets one within 20 s in a quarter of all places. From this call on, in
/// the whole process, contacts between boxes deeper than 20 mm don't count: a real one isn't that deep, as 2 ms at 2
/// m/s are 4 mm. Call it before any simulation runs; further calls do nothing.
void drop_phantom_contacts();

}  // namespace pmg::sim
