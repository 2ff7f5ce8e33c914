// A library has to have a source: this one is there for its precompiled headers.
