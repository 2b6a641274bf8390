# docker build -t airhilt . && mkdir -p runs
# docker run --rm --user "$(id -u):$(id -g)" -v "$PWD/runs:/data/runs" \
#     airhilt cosim --scenario s02a_headon

FROM python:3.11.14-slim@sha256:c8271b1f627d0068857dce5b53e14a9558603b527e46f1f901722f935b786a39 AS build
WORKDIR /source
COPY pyproject.toml README.md LICENSE ./
COPY airhilt airhilt
COPY aircraft aircraft
COPY airports airports
COPY scenarios scenarios
COPY bridges bridges
RUN pip wheel --no-cache-dir --no-deps --wheel-dir /wheels .

FROM python:3.11.14-slim@sha256:c8271b1f627d0068857dce5b53e14a9558603b527e46f1f901722f935b786a39
RUN --mount=type=bind,from=build,source=/wheels,target=/wheels \
    --mount=type=bind,source=constraints.txt,target=/constraints.txt \
    pip install --no-cache-dir --no-compile -c /constraints.txt /wheels/*.whl
# espeak-ng, the default voice, is in the wheel espeakng-loader; docs/licences.md lists the rest.
LABEL org.opencontainers.image.licenses="Apache-2.0 AND GPL-3.0-or-later AND LGPL-2.1-or-later"
RUN useradd --uid 1000 --create-home airhilt \
    && install -d -o airhilt -g airhilt -m 1777 /data /data/runs /data/cache
# The cache is in /data/cache, so that any user (docker run --user) may write it.
ENV XDG_CACHE_HOME=/data/cache PYTHONUNBUFFERED=1
USER airhilt
WORKDIR /data
VOLUME /data/runs
ENTRYPOINT ["airhilt"]
CMD ["--help"]
