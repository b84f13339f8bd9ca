#pragma once
// How often this program has asked for memory. Counts malloc itself, as Eigen does not go through operator
// new. Always 0 under sanitizers, which bring a malloc of their own.

long allocation_count();
bool allocation_count_works();
