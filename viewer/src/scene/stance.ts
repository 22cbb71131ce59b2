// Where a person stands who holds the handle.

export const STAND_BACK = 0.52; // m, from the handle
export const STAND_LEFT = 0.3; // m: the right hand holds
