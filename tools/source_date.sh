# To be sourced in the root of the sources: SOURCE_DATE_EPOCH for packages, of which the same commit gives
# the same bytes. Sources without a repository have the time of their change log.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || stat --format=%Y CHANGELOG.md)}
export SOURCE_DATE_EPOCH
