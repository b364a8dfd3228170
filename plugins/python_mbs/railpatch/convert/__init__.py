"""The sub-command that makes cases of CONTACT's input files."""
