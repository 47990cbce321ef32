"""What RViz calls displays: each makes a Drawing of the messages of its topics."""
