"""Actions: goals in; acceptance, feedback, status and one result out, on both ends."""
