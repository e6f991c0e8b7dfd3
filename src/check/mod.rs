//! Everything that can be wrong with a plan: one file a check, named as its finding.
