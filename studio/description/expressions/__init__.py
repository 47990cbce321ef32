"""The expressions in `${}` and `$()`: parsed, allowed or refused, evaluated within bounds."""
