"""What `${}` and `$()` may compute: parsed, allowed or refused, evaluated within bounds."""
