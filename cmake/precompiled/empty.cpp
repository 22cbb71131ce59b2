// Holds the precompiled headers of a kind of code.
