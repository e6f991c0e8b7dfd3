//! Plan files on disk: loading, and saving without ever losing what was there.
