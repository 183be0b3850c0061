# SPDX-License-Identifier: Apache-2.0
# The commands on Ubuntu 24.04, or on another release:
#   docker build -t penumbra [--build-arg BASE=ubuntu:22.04] .
#   docker run --rm -v "$PWD:/data" penumbra run RECORDING -o OUT
ARG BASE=ubuntu:24.04
FROM ${BASE} AS build
ENV DEBIAN_FRONTEND=noninteractive
COPY scripts/packages.sh /source/scripts/
RUN apt-get update -qq \
 && apt-get install -y -qq --no-install-recommends ca-certificates git \
      $(/source/scripts/packages.sh build | grep -vx libmeshoptimizer-dev)
# Ubuntu 22.04 does not package it.
RUN apt-get install -y -qq --no-install-recommends libmeshoptimizer-dev \
 || { git clone -q --depth 1 -b v0.18 https://github.com/zeux/meshoptimizer /meshoptimizer \
   && cmake -S /meshoptimizer -B /meshoptimizer/build -G Ninja -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
   && cmake --build /meshoptimizer/build \
   && cmake --install /meshoptimizer/build --prefix /usr/local; }
COPY . /source
RUN cd /source \
 && cmake --preset release -B /build -DPENUMBRA_BUILD_TESTS=OFF -DPENUMBRA_BUILD_EXAMPLES=OFF \
      -DPENUMBRA_WARNINGS_AS_ERRORS=OFF \
 && cmake --build /build --target penumbra_app
# The packages that own the libraries it loads.
RUN ldd /build/apps/penumbra/penumbra | sed -n 's|.* => .*/\([^ ]*\) .*|*/\1|p' \
  | xargs dpkg-query -S | cut -d: -f1 | sort -u > /build/packages

FROM ${BASE}
COPY --from=build /build/packages /build/apps/penumbra/penumbra /usr/local/bin/
RUN apt-get update -qq \
 && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
      $(cat /usr/local/bin/packages) \
 && rm -rf /usr/local/bin/packages /var/lib/apt/lists
WORKDIR /data
ENTRYPOINT ["penumbra"]
